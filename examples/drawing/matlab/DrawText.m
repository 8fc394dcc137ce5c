function image = DrawText(image, left, top, text, color)
%DRAWTEXT Puts letters of 3 x 5 pixels, doubled, into an image of rows x columns x 3.
%   left and top are their upper left corner, counted from 0; color is red, green, blue. What
%   lies outside is left out. There are the letters of the examples in C++: digits, letters as
%   capitals, blanks and . - + : / = ,
  persistent letters
  if isempty(letters)
    file = fullfile(fileparts(mfilename('fullpath')), '..', 'letters.inc');
    words = regexp(fileread(file), 'Letter\{''(.)'', \{([\d, ]+)\}\}', 'tokens');
    letters = containers.Map('KeyType', 'char', 'ValueType', 'any');
    for i = 1:numel(words)
      rows = sscanf(words{i}{2}, '%d,');
      letters(words{i}{1}) = kron(rem(floor(rows ./ [4 2 1]), 2), ones(2)) > 0;
    end
  end
  for c = upper(text)
    if isKey(letters, c)
      [row, column] = find(letters(c));
      row = top + row;
      column = left + column;
      for i = find(min(row, column) >= 1 & row <= size(image, 1) & column <= size(image, 2))'
        image(row(i), column(i), :) = color;
      end
    end
    left = left + 8;
  end
end
