function rr_serve(stop)
%RR_SERVE Serve the rig; `stop` is its function of that name.
rig = struct('add', @(a, b) a + b);
if nargin > 0
  rig.stop = stop;
end
RobotRaconteur.RegisterServiceType(fullfile(getenv('RR_TEST_FILES'), 'experimental.rig.robdef'));
name = sprintf('rig%d', nargin);
RobotRaconteur.RegisterService(name, 'experimental.rig.Rig', rig);
setenv('RR_TEST_SERVED', sprintf('rr+tcp://127.0.0.1:%d/?service=%s', ...
                                 RobotRaconteur.StartServer(0, '127.0.0.1'), name));
end
