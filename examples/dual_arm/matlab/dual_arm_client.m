function dual_arm_client(url, picture)
%DUAL_ARM_CLIENT Moves both arms by a table and by a gamepad, and plots what was seen.
%   dual_arm_client('rr+tcp://127.0.0.1:6258?service=DualArm', 'arms.png')
  robot = RobotRaconteur.Connect(url);
  names = robot.signal_names();
  fprintf('%d signals: %s\n', numel(names), strjoin(names(:)', ', '));
  state = robot.state.Connect();
  state.InValueLifespan = 5;
  state.WaitInValueValid(5);

  % The bases stand; the table begins where the arms are, at the loop's sample `first`.
  rows = both_arms_wave(3, 301);
  table = robot.table;
  table(1:numel(rows)) = reshape(rows', [], 1);
  robot.change_mode(1);
  now = robot.state.PeekInValue();
  first = double(now.sample) + 100;
  robot.follow_table(size(rows, 1), first);
  seen = watch(state, first + 3200);
  time = ([seen.sample] - first) / 1000;
  position = [seen.position];
  on_way = time > 0.2 & time < 3;
  wanted = interp1(rows(:, 1), rows(:, 2:end), time(on_way))';
  off = max(max(abs(position(1:12, on_way) - wanted(1:12, :))));
  fprintf('%d looks: the arms swing by %.2f rad and are at most %.3f rad off the table\n', ...
          numel(seen), max(position(1, :)) - min(position(1, :)), off);
  fprintf('the right arm is the mirror image of the left one to %.4f rad\n', ...
          max(max(abs(position(1:6, :) + position(7:12, :)))));

  % Both sticks forward for half a second of the robot's time, with what they do to both arms.
  before = robot.read_signal('state.position');
  robot.change_mode(2);
  robot.gamepad.PokeOutValue(struct('sticks', [1 0 1 0], 'buttons', 0));
  begun = double(robot.state.PeekInValue().sample);
  pushed = watch(state, begun + 500);
  robot.gamepad.PokeOutValue(struct('sticks', [0 0 0 0], 'buttons', 0));
  let_go = double(robot.state.PeekInValue().sample);
  rest = watch(state, let_go + 300);
  after = robot.read_signal('state.position');
  moved = after - before;
  speed = moved([1 7]) / (let_go - begun) * 1000;
  fprintf('gamepad: both arms turned, left at %.1f rad/s, right at %.1f rad/s\n', speed);
  robot.write_signal('orders.mode', 0);

  try
    robot.change_mode(3);
  catch err
    fprintf('mode 3 is refused: %s: %s\n', err.identifier, err.message);
  end
  for node = 0:2
    counts = robot.link_counts(node);
    fprintf('node %d: more than 3000 packets: %d, lost %d, late %d, twice %d\n', node, ...
            counts(1) > 3000, counts(2:4));
  end

  all = [seen, pushed, rest];
  time = ([all.sample] - first)' / 1000;
  position = [all.position]';
  target = [all.target]';
  image = [PlotImage(300, 800, 'arms, rad, over s', time, position(:, [1 2 7 8]), ...
                     {'left 1', 'left 2', 'right 1', 'right 2'}); ...
           PlotImage(300, 800, 'behind the target, rad, over s', time, ...
                     target(:, [1 7]) - position(:, [1 7]), {'left 1', 'right 1'})];
  imwrite(image, picture);
  fprintf('a picture of %d x %d pixels is in %s\n', size(image, 2), size(image, 1), picture);
end

function seen = watch(state, last)
%WATCH The states up to the robot's sample `last`, each once: the robot's clock counts, not ours.
  seen = [];
  while isempty(seen) || seen(end).sample < last
    value = state.InValue;
    value.sample = double(value.sample);
    if isempty(seen) || value.sample > seen(end).sample
      seen = [seen, value];
    end
    RobotRaconteur.Sleep(0.01);
  end
end

function rows = both_arms_wave(seconds, count)
%BOTH_ARMS_WAVE Rows of a time and 18 positions: the right arm is the left one's mirror image.
  part = (0:count - 1)' / (count - 1);
  phase = 2 * pi * part - sin(2 * pi * part);
  left = sin(phase * [1 2 1 2 1 2]) .* [0.6 0.4 0.3 0.2 0.2 0.1];
  rows = [seconds * part, left, -left, zeros(count, 6)];
end
