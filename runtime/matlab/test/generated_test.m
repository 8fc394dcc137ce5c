% What generated classes have besides what the dynamic object has.

%!function c = bench()
%!  persistent kept
%!  if isempty(kept)
%!    kept = rr_bench();
%!  end
%!  c = kept;
%!endfunction

%!test % classes
%! c = bench();
%! assert(class(c), 'experimental.bench.Bench');
%! assert(class(c.get_tool()), 'experimental.bench.Tool');
%! assert(class(c.get_any_tool()), 'RobotRaconteurObject');
%! dynamic = RobotRaconteur.ConnectService( ...
%!   ['rr+tcp://127.0.0.1:', getenv('RR_TEST_PORT'), '/?service=bench']);
%! again = experimental.bench.Bench(dynamic);
%! again.v_int32 = 77;
%! assert(dynamic.v_int32, int32(77));
%! assert(again == dynamic);

%!error id=RobotRaconteur:ServiceError experimental.bench.Tool(bench())
%!error <not a `experimental.bench.Tool`> experimental.bench.Tool(bench())
%!error id=RobotRaconteur:InvalidArgument experimental.bench.Bench()
%!error id=RobotRaconteur:MemberNotFound rrmex('member', bench().rr_h, 'nothing')
%!error <run robdef again> rrmex('member', bench().rr_h, 2)

%!test % constants, enums and exceptions without a connection
%! assert(experimental.bench.Constants.LIMIT, int32(42));
%! assert(experimental.bench.Constants.WEIGHTS, [0.25; -0.5]);
%! assert(experimental.bench.Constants.GREETING, 'hello');
%! assert(experimental.bench.Constants.LIMITS.least, int32(42));
%! assert(experimental.bench.Tool.TEETH, int32(7));
%! assert(experimental.bench.Mode.failed, int32(-1));
%! c = bench();
%! c.v_mode = experimental.bench.Mode.running;
%! assert(c.v_mode, experimental.bench.Mode.running);
%! try
%!   c.lose_tool('attic');
%!   error('not thrown');
%! catch err
%!   assert(experimental.bench.ToolLost.is(err));
%! end
%! try
%!   experimental.bench.ToolLost.raise('100% lost');
%! catch err
%!   assert(err.identifier, experimental.bench.ToolLost.identifier);
%!   assert(err.message, '100% lost');
%! end

%!test % names of enums, without a connection
%! assert(experimental.bench.Mode.get_name(3), 'running');
%! assert(experimental.bench.Mode.get_name(experimental.bench.Mode.failed), 'failed');

%!error id=RobotRaconteur:OutOfRange experimental.bench.Mode.get_name(12)
%!error <`experimental.bench.Mode` has no value 12: idle \(0\), running \(3\), failed \(-1\)> ...
%!  experimental.bench.Mode.get_name(12)

%!test % the identifier of an exception's class is the one that the runtime gives
%! c = bench();
%! try
%!   c.lose_tool('attic');
%! catch err
%! end
%! assert(experimental.bench.ToolLost.identifier, 'experimental:bench:ToolLost');
%! assert(err.identifier, experimental.bench.ToolLost.identifier);

%!test % structs
%! r = experimental.bench.Report();
%! assert(fieldnames(r), {'count'; 'text'; 'numbers'; 'mode'; 'next'; 'extra'});
%! assert(r.count, int32(0));
%! r = experimental.bench.Report('count', 5, 'numbers', [1 2]);
%! assert(r.count, int32(5));
%! assert(r.numbers, [1; 2]);
%! r.next = experimental.bench.Report('text', 'inner');
%! c = bench();
%! c.report = r;
%! assert(c.report.next.text, 'inner');

%!test % pods and namedarrays
%! s = experimental.bench.Sample('sequence', 3, 'acceleration', [1 2 3]);
%! assert(class(s.acceleration), 'single');
%! assert(s.acceleration, single([1; 2; 3]));
%! assert(experimental.bench.Vector3(), zeros(3, 1));
%! assert(experimental.bench.Vector3('x', 1, 'y', 2, 'z', 3), [1; 2; 3]);
%! assert(experimental.bench.Vector3([4 5 6]), [4; 5; 6]);

%!test % values that need classes of their own
%! s = experimental.bench.Shapes('picture', struct('dims', [2 3 1], 'array', 1:6), 'gain', 1, ...
%!   'limits', RobotRaconteurMap('', 5));
%! assert(rr_isequal(s.picture, RobotRaconteurMultiDimArray([2 3 1], uint8(1:6))));
%! assert(iscomplex(s.gain));
%! assert(s.limits(''), 5);
%! c = bench();
%! c.shapes = s;
%! assert(rr_isequal(c.shapes, s));
%! c.shapes.picture(2, 3) = 60;
%! assert(c.shapes.picture.dims, [2 3 1]);
%! assert(c.shapes.picture(end), uint8(60));

%!error <experimental.bench.Report.count: int32 cannot hold 1.5> experimental.bench.Report('count', 1.5)
%!error id=RobotRaconteur:DataTypeMismatch experimental.bench.Sample('acceleration', [1 2])
%!error id=RobotRaconteur:DataTypeMismatch experimental.bench.Vector3([1 2])
%!error <has no field `nothing`> experimental.bench.Report('nothing', 1)

%!test % help
%! assert(~isempty(strfind(evalc('help experimental.bench.Bench'), 'Has a member of each kind')));

%!test % many calls leave nothing behind
%! c = rr_bench();
%! held = rrmex('node').held;
%! for k = 1:100
%!   c.v_double = k;
%!   t = c.get_tool();
%!   t.force = k;
%! end
%! assert(c.v_double, 100);
%! clear t
%! assert(rrmex('node').held, held);
