function c = rr_bench(service, varargin)
%RR_BENCH As the function of the same name one folder above, but with the generated class.
if nargin < 1
  service = 'bench';
end
c = experimental.bench.Bench( ...
  ['rr+tcp://127.0.0.1:', getenv('RR_TEST_PORT'), '/?service=', service], varargin{:});
end
