function c = rr_bench(service, varargin)
%RR_BENCH A new connection to the test service; `service` is bench or guarded.
if nargin < 1
  service = 'bench';
end
c = RobotRaconteur.ConnectService( ...
  ['rr+tcp://127.0.0.1:', getenv('RR_TEST_PORT'), '/?service=', service], varargin{:});
end
