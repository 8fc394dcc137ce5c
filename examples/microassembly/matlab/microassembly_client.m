function microassembly_client(url, picture)
%MICROASSEMBLY_CLIENT Has two probes take a part and carry it to the side, with both cameras.
%   microassembly_client('rr+tcp://127.0.0.1:6258?service=Cell', 'cell.png')
  cell = RobotRaconteur.Connect(url);
  light = cell.get_auxiliary();
  dark = look(cell, light, 0);
  image = look(cell, light, 1);
  fprintf('cameras `%s` and `%s`: brightness %.0f without light, %.0f with\n', ...
          cell.get_camera(0).name, cell.get_camera(1).name, brightness(dark), brightness(image));

  % 1 to 6: left probe, coarse x, y, z, fine x, y, z; 7 to 12: right probe; 13 to 15: stage.
  at = zeros(15, 1);
  at([3 9]) = 200;
  at(13) = 80;
  [state, way] = move(cell, at, []);
  fprintf('the stage has brought the part to %.1f um\n', state.part(1));
  at([1 7]) = 80 + [430; -430];
  [~, way] = move(cell, at, way);
  at([3 9]) = 0;
  [~, way] = move(cell, at, way);
  at([4 10]) = [15; -15];
  [state, way] = move(cell, at, way);
  fprintf('fine axes at %.1f and %.1f um: the part is held: %d\n', state.position([4 10]), ...
          state.is_gripped);
  at([3 9]) = 120;
  [~, way] = move(cell, at, way);
  at([1 7]) = at([1 7]) + 150;
  [~, way] = move(cell, at, way);
  image = [image; look(cell, light, 1)];
  at([3 9]) = 0;
  [~, way] = move(cell, at, way);
  at([4 10]) = [-10; 10];
  [state, way] = move(cell, at, way);
  fprintf('let go at %.1f um: the part is held: %d\n', state.part(1), state.is_gripped);

  % Home by a table: rows of a time in seconds and 15 positions.
  up = at;
  up([3 9]) = 200;
  home = zeros(15, 1);
  home([3 9 13]) = [200; 200; 80];
  rows = [0, at'; 0.3, up'; 1, home'];
  table = cell.table;
  table(1:numel(rows)) = reshape(rows', [], 1);
  cell.follow_table(size(rows, 1));
  [state, way] = arrive(cell, home, way);
  fprintf('home by a table: the probes are at %.2f and %.2f um, the part at %.0f um\n', ...
          state.position([1 7]), state.part(1));
  image = [image; look(cell, light, 1)];

  try
    cell.get_camera(2);
  catch err
    fprintf('camera 2 is refused: %s: %s\n', err.identifier, err.message);
  end
  position = [way.position]';
  part = [way.part]';
  time = ([way.sample]' - way(1).sample) / 1000;
  plot = PlotImage(300, size(image, 2), 'um over s', time, ...
                   [part(:, 1), position(:, [1 3 13])], ...
                   {'part x', 'left x', 'left z', 'stage x'});
  image = [image; plot];
  imwrite(image, picture);
  fprintf('a picture of %d x %d pixels is in %s\n', size(image, 2), size(image, 1), picture);
end

function image = look(cell, auxiliary, light)
%LOOK Both cameras beside each other, with a border to what comes below.
  auxiliary.light = light;
  views = {[], []};
  for i = 0:1
    picture = cell.get_camera(i).capture();
    pixels = reshape(picture.data, 3, double(picture.width), double(picture.height));
    views{i + 1} = permute(pixels, [3 2 1]);
  end
  image = [views{1}, 255 * ones(size(views{1}, 1), 8, 3, 'uint8'), views{2}];
  image = [image; 255 * ones(8, size(image, 2), 3, 'uint8')];
end

function value = brightness(image)
%BRIGHTNESS Of what the first camera sees, without the borders.
  pixels = double(image(1:end - 8, 1:(end - 8) / 2, :));
  value = mean(pixels(:));
end

function [state, way] = move(cell, position, way)
%MOVE Sends the axes there and waits until they stand.
  cell.target.PokeOutValue(struct('position', position));
  [state, way] = arrive(cell, position, way);
end

function [state, way] = arrive(cell, position, way)
%ARRIVE Waits until the axes stand there, to a step of the coarse ones; what is seen joins `way`.
  first = [];
  while true
    state = cell.state.PeekInValue();
    state.sample = double(state.sample);
    if isempty(way) || state.sample > way(end).sample
      way = [way, state];
    end
    if ~state.is_moving && all(abs(state.position - position) < 1.25)
      return;
    end
    if isempty(first)
      first = state.sample;
    elseif state.sample > first + 5000
      error('the axes have not arrived within five seconds of their clock');
    end
    RobotRaconteur.Sleep(0.01);
  end
end
