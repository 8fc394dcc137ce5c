function serve_lamp(definition)
%SERVE_LAMP Offer a lamp of examples/encrypted from Octave for a minute, for clients on another system.
%   Prints `ready: URL`. The definition is a file. A brightness that there is not is refused.
  state = containers.Map({'brightness'}, {0});
  lamp = struct('brightness', @() state('brightness'), 'set_brightness', @(value) set_brightness(state, value));
  RobotRaconteur.RegisterServiceType(definition);
  RobotRaconteur.RegisterService('lamp', 'experimental.lamp.Lamp', lamp);
  printf('ready: rr+tcp://127.0.0.1:%d/?service=lamp\n', RobotRaconteur.StartServer(0, '127.0.0.1'));
  fflush(stdout);
  RobotRaconteur.ServeFor(60);
end

function set_brightness(state, value)
  if value < 0 || value > 1
    error('RobotRaconteur:OutOfRange', 'a lamp is from 0 to 1');
  end
  state('brightness') = value;
end
