function asom_client(url, picture, grid)
%ASOM_CLIENT Scans a grid of places, one frame for each, with a flat mirror and a sharpened one.
%   asom_client('rr+tcp://127.0.0.1:6258?service=CameraHost', 'scan.png', 3)
  if nargin < 3
    grid = 3;
  end
  tile = 48;  % pixels in the middle of a frame
  host = RobotRaconteur.Connect(url);
  scanner = host.get_robdevice(int32(0));
  mirror = host.get_robdevice(int32(1));
  camera = host.get_robcamera(int32(0));
  fprintf('`%s`, `%s`, `%s`\n', scanner.Name, mirror.Name, camera.Name);

  flat = zeros(tile * grid, 'uint8');
  sharp = flat;
  values = zeros(grid * grid, 2);
  frames = 0;
  for place = 0:grid * grid - 1
    row = floor(place / grid);
    column = rem(place, grid);
    angles = (2 * [column row] + 1 - grid) * tile / 128;
    scanner.SetProperty('Angles', angles);
    off = max(abs(scanner.GetProperty('Angles') - angles'));
    if off > 1e-3
      error('the mirror is off by %g', off);
    end
    [before, after, taken] = sharpen(mirror, camera);
    frames = frames + taken;
    values(place + 1, :) = [sharpness(before), sharpness(after)];
    rows = row * tile + (1:tile);
    columns = column * tile + (1:tile);
    flat(rows, columns) = middle(before, tile);
    sharp(rows, columns) = middle(after, tile);
  end
  fprintf('%d places, %d frames\n', grid * grid, frames);
  fprintf('sharpness %.1f with a flat mirror, %.1f sharpened\n', mean(values));
  fprintf('places that became sharper: %d\n', sum(values(:, 2) > values(:, 1)));
  try
    scanner.SetProperty('Angles', [2 0]);
  catch err
    fprintf('an angle of 2 is refused: %s: %s\n', err.identifier, err.message);
  end

  image = kron([flat, 255 * ones(tile * grid, 8, 'uint8'), sharp], ones(2, 'uint8'));
  image = [255 * ones(24, size(image, 2), 'uint8'); image];
  image = repmat(image, [1 1 3]);
  image = DrawText(image, 4, 8, 'flat mirror', [0 0 0]);
  image = DrawText(image, 2 * tile * grid + 20, 8, 'sharpened', [0 0 0]);
  imwrite(image, picture);
  fprintf('a picture of %d x %d pixels is in %s\n', size(image, 2), size(image, 1), picture);
end

function [first, best, frames] = sharpen(mirror, camera)
%SHARPEN The frame with a flat mirror, and the sharpest of the closed loop; the mirror stays so.
%   Each shape but tip and tilt, which only move the picture, is tried to both sides and at the top
%   of the parabola through the three values.
  shape = zeros(9, 1);
  first = expose(mirror, camera, shape);
  best = first;
  frames = 1;
  for step = [0.2 0.1]
    for i = 3:9
      value = sharpness(best);
      sides = [0 0];
      pictures = cell(1, 2);
      for k = 1:2
        tried = shape;
        tried(i) = tried(i) + (2 * k - 3) * step;
        pictures{k} = expose(mirror, camera, tried);
        sides(k) = sharpness(pictures{k});
      end
      frames = frames + 2;
      curvature = sum(sides) - 2 * value;
      if curvature < 0
        shift = step * (sides(1) - sides(2)) / (2 * curvature);
      else
        shift = step * sign(sides(2) - sides(1));
      end
      tried = shape;
      tried(i) = tried(i) + min(max(shift, -step), step);
      frame = expose(mirror, camera, tried);
      frames = frames + 1;
      if sharpness(frame) > value
        shape = tried;
        best = frame;
      end
    end
  end
  mirror.SetProperty('Actuators', shape);
end

function frame = expose(mirror, camera, shape)
%EXPOSE A frame with the deformable mirror pushed so: rows x columns of one byte.
  mirror.SetProperty('Actuators', shape);
  bitmap = camera.GetCurrentStreamFrameCameraBitmap();
  frame = reshape(bitmap.data, double(bitmap.width), double(bitmap.height))';
end

function value = sharpness(frame)
%SHARPNESS The mean square of the differences of neighbours.
  frame = double(frame);
  across = diff(frame, 1, 2);
  down = diff(frame, 1, 1);
  value = (sum(across(:) .^ 2) + sum(down(:) .^ 2)) / numel(frame);
end

function part = middle(frame, size_wanted)
%MIDDLE The middle of a frame.
  edge = (size(frame) - size_wanted) / 2;
  part = frame(edge(1) + (1:size_wanted), edge(2) + (1:size_wanted));
end
