function image = PlotImage(rows, columns, label, x, y, names)
%PLOTIMAGE A plot as an image of rows x columns x 3: each column of y over x, with its name.
%   Octave without a display has no figures to print; an image is written by imwrite everywhere.
  colors = uint8([31 119 180; 255 127 14; 44 160 44; 214 39 40; 148 103 189; 140 86 75]);
  left = 68;
  top = 40;
  height = rows - top - 28;
  width = columns - left - 28;
  image = repmat(uint8(255), [rows, columns, 3]);
  low = [min(x(:)), min(y(:))];
  high = [max(x(:)), max(y(:))];
  is_flat = high - low < 1e-12;
  low(is_flat) = low(is_flat) - 0.5;
  high(is_flat) = high(is_flat) + 0.5;
  for i = 0:4
    column = left + round(i / 4 * width);
    row = top + height - round(i / 4 * height);
    image(top + 1:top + height + 1, column + 1, :) = 190;
    image(row + 1, left + 1:left + width + 1, :) = 190;
    % No more digits than the range has a use for.
    unit = 10 .^ (floor(log10(high - low)) - 2);
    at = round((low + i / 4 * (high - low)) ./ unit) .* unit;
    text = sprintf('%.3g', at(1));
    image = DrawText(image, column - 4 * numel(text), top + height + 6, text, [0 0 0]);
    text = sprintf('%.3g', at(2));
    image = DrawText(image, left - 4 - 8 * numel(text), row - 5, text, [0 0 0]);
  end
  image = DrawText(image, left, 8, label, [0 0 0]);
  name_at = left;
  for i = 1:size(y, 2)
    color = colors(1 + rem(i - 1, size(colors, 1)), :);
    image = DrawText(image, name_at, 24, names{i}, color);
    name_at = name_at + 8 * numel(names{i}) + 16;
    points = [(x(:) - low(1)) / (high(1) - low(1)) * width, ...
              (1 - (y(:, i) - low(2)) / (high(2) - low(2))) * height];
    for j = 2:size(points, 1)
      steps = ceil(max(abs(points(j, :) - points(j - 1, :)))) + 1;
      part = (0:steps)' / steps;
      line = round(points(j - 1, :) + part * (points(j, :) - points(j - 1, :)));
      place = sub2ind([rows, columns], top + 1 + line(:, 2), left + 1 + line(:, 1));
      for k = 1:3
        image(place + (k - 1) * rows * columns) = color(k);
      end
    end
  end
end
