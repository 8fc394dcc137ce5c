% SPDX-License-Identifier: Apache-2.0
% What light_client.cpp asserts of a light, from Octave: with_light gives the URL in ROBDEF_LIGHT_URL.
1;

function log_faded(of, color)
  global faded
  faded{of}{end + 1} = [color.red; color.green; color.blue];
end

function answer = both_faded()
  global faded
  answer = ~isempty(faded{1}) && ~isempty(faded{2});
end

function answer = eventually(condition)
  start = tic();
  answer = condition();
  while ~answer && toc(start) < 20
    RobotRaconteur.Poll(0.01);
    answer = condition();
  end
end

function assert_refused(identifier, f)
  try
    f();
  catch err
    assert(err.identifier, identifier);
    return
  end
  error('not refused');
end

function set_color(light, color)
  light.color = color;
end

function color = rgb(red, green, blue)
  color = struct('red', single(red), 'green', single(green), 'blue', single(blue));
end

global faded
light = RobotRaconteur.Connect(getenv('ROBDEF_LIGHT_URL'));

% It keeps its colour.
assert(type(light), 'example.light.Light');
light.color = rgb(0.7, 0.3, 0.1);
assert(light.color, rgb(0.7, 0.3, 0.1));
assert_refused('RobotRaconteur:OutOfRange', @() set_color(light, rgb(0, 1.25, 0)));
assert_refused('RobotRaconteur:NullValue', @() set_color(light, []));
assert(light.color, rgb(0.7, 0.3, 0.1));

% It sees light.
assert(abs(light.brightness - 255.5) <= 1);
assert(abs(light.sensor.PeekInValue() - 255.5) <= 1);
sensor = light.sensor.Connect();
assert(sensor.WaitInValueValid(10));
assert(abs(sensor.InValue - 255.5) <= 1);
first = sensor.LastValueReceivedTime;
assert(eventually(@() ~isequal(sensor.LastValueReceivedTime, first)));

% It tells all clients when a fade has ended.
another = RobotRaconteur.Connect(getenv('ROBDEF_LIGHT_URL'));
faded = {{}, {}};
listener = addlistener(light, 'faded', @(color) log_faded(1, color));
listener_too = addlistener(another, 'faded', @(color) log_faded(2, color));
light.color = rgb(0, 0, 0);
light.fade(rgb(1, 0.5, 0.25), 0.2);
assert(eventually(@both_faded));
assert(faded, {{single([1; 0.5; 0.25])}, {single([1; 0.5; 0.25])}});
assert(another.color, rgb(1, 0.5, 0.25));

% It refuses a fade that cannot be.
assert_refused('RobotRaconteur:OutOfRange', @() light.fade(rgb(0, 0, 0), 61));
assert_refused('RobotRaconteur:OutOfRange', @() light.fade(rgb(0, 0, 0), -0.5));
assert_refused('RobotRaconteur:OutOfRange', @() light.fade(rgb(0, 0, -1), 1));
printf('the light holds\n');
