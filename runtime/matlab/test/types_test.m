% The table of types in docs/howto/matlab.md, each row in both directions.

%!function c = bench()
%!  persistent kept
%!  if isempty(kept)
%!    kept = rr_bench();
%!  end
%!  c = kept;
%!endfunction

%!function check(name, given, wanted)
%!  rr_check(bench(), name, given, wanted);
%!endfunction

%!function refused(name, given, text)
%!  rr_refused(bench(), name, given, text);
%!endfunction

%!test % numbers: any class that fits
%! check('v_double', int8(5), 5);
%! check('v_double', NaN, NaN);
%! check('v_double', -Inf, -Inf);
%! check('v_single', 0.1, single(0.1));
%! check('v_int8', -128, int8(-128));
%! check('v_uint8', 255, uint8(255));
%! check('v_int16', 5, int16(5));
%! check('v_uint16', 65535, uint16(65535));
%! check('v_int32', int64(-7), int32(-7));
%! check('v_uint32', 2^32 - 1, uint32(2^32 - 1));
%! check('v_int64', intmin('int64'), intmin('int64'));
%! check('v_uint64', intmax('uint64'), intmax('uint64'));
%! check('v_int64', 2^53, int64(2^53));
%! check('v_int32', true, int32(1));
%! check('v_bool', true, true);
%! check('v_bool', 0, false);

%!test % numbers that do not fit
%! refused('v_int16', 70000, 'member v_int16: int16 cannot hold 70000');
%! refused('v_int16', 1.5, 'member v_int16: int16 cannot hold 1.5');
%! refused('v_uint8', -1, 'member v_uint8: uint8 cannot hold -1');
%! refused('v_int32', NaN, 'member v_int32: int32 cannot hold NaN');
%! refused('v_int64', 2^63, 'member v_int64: int64 cannot hold 9.2233720368547758e+18');
%! refused('v_double', intmax('int64'), 'member v_double: double cannot hold 9223372036854775807');
%! refused('v_single', 1e300, 'member v_single: single cannot hold 1.0000000000000001e+300');
%! refused('v_bool', 2, 'member v_bool: bool cannot hold 2');
%! refused('v_double', 1 + 2i, 'member v_double: expected double, got complex double');
%! refused('v_double', [1 2], 'member v_double: expected double, got 1x2 double');
%! refused('v_double', [], 'member v_double: expected double, got 0x0 double');
%! refused('v_double', 'x', 'member v_double: expected double, got char');
%! refused('v_double', sparse(5), 'member v_double: expected double, got sparse double');
%! refused('v_double', {5}, 'member v_double: expected double, got cell');

%!test % complex numbers
%! check('v_cdouble', 1 + 2i, 1 + 2i);
%! check('v_csingle', single(1 - 2i), single(1 - 2i));
%! check('a_cdouble', [1i; 2], [1i; 2]);
%! check('v_cdouble', 3, complex(3, 0));
%! check('v_csingle', 0, complex(single(0), 0));
%! check('a_cdouble', [1 2], complex([1; 2], 0));
%! check('a_cdouble', [], complex(zeros(0, 1), 0));
%! check('m_cdouble', [1 2; 3 4], complex([1 2; 3 4], 0));
%! check('l_cdouble', {1, 2i}, {complex(1, 0); 2i});
%! check('s_cdouble', struct('a', 5), containers.Map({'a'}, {complex(5, 0)}, 'UniformValues', false));
%! check('any', RobotRaconteurVarValue(7, 'cdouble[]'), RobotRaconteurVarValue(complex(7, 0), 'cdouble[]'));
%! check('v_cdouble', complex(NaN, -Inf), complex(NaN, -Inf));

%!test % strings
%! check('v_string', 'some text', 'some text');
%! check('v_string', '', '');
%! check('v_string', ['gr', char([195 188]), char([195 159]), 'e'], ['gr', char([195 188 195 159]), 'e']);
%! check('v_string', "a\0b", "a\0b");
%! refused('v_string', 5, 'member v_string: expected string, got double');
%! refused('v_string', ['ab'; 'cd'], 'member v_string: expected string, got 2x2 char');

%!test % enums: numbers or names
%! check('v_mode', 3, int32(3));
%! check('v_mode', 'failed', int32(-1));
%! refused('v_mode', 'none', 'member v_mode: expected experimental.bench.Mode (idle, running, failed), got "none"');

%!test % arrays are columns
%! check('a_double', [1 2 3], [1; 2; 3]);
%! check('a_double', [], zeros(0, 1));
%! check('a_double', 7, 7);
%! check('a_double', int8([1; 2]), [1; 2]);
%! check('a_double', 1:4, [1; 2; 3; 4]);
%! check('a_uint8', [0 255], uint8([0; 255]));
%! check('a_bool', [true false], [true; false]);
%! check('a_bool', [], false(0, 1));
%! check('a_fixed', [1 2 3 4], int16([1; 2; 3; 4]));
%! check('a_most', 1:6, uint8(1:6)');
%! refused('a_double', [1 2; 3 4], 'member a_double: expected double[], got 2x2 double');
%! refused('a_uint8', [1 256], 'member a_uint8(2): uint8 cannot hold 256');
%! refused('a_fixed', 1:3, 'member a_fixed: expected int16[4], got 3 items');
%! refused('a_most', 1:7, 'member a_most: expected uint8[6-], got 7 items');
%! refused('a_double', 'abc', 'member a_double: expected double[], got 1x3 char');

%!test % arrays of several dimensions, in the order of the interpreter
%! check('m_single', single(magic(3)), single(magic(3)));
%! check('m_single', single(reshape(1:24, 2, 3, 4)), single(reshape(1:24, 2, 3, 4)));
%! check('m_single', [], single([]));
%! check('m_fixed', [1 2 3; 4 5 6], int32([1 2 3; 4 5 6]));
%! check('m_bool', [true false; false true], [true false; false true]);
%! refused('m_fixed', eye(2), 'member m_fixed: expected int32[2,3], got 2x2');
%! check('m_column', [1 2 3]', int32([1; 2; 3]));
%! check('m_single', zeros(0, 3), zeros(0, 3, 'single'));

%!test % lists are columns of cells
%! check('l_double', {1, int8(2)}, {1; 2});
%! check('l_double', {}, cell(0, 1));
%! check('l_double', [], []);
%! check('l_string', {'a'; ''}, {'a'; ''});
%! refused('l_double', {1, 'x'}, 'member l_double{2}: expected double, got char');
%! refused('l_double', 5, 'member l_double: expected double{list}, got double');

%!test % maps
%! check('i_double', containers.Map({1, -2}, {0.5, 1.5}, 'UniformValues', false), ...
%!       containers.Map(int32([-2 1]), {1.5, 0.5}, 'UniformValues', false));
%! c = bench();
%! c.i_double = containers.Map('KeyType', 'int32', 'ValueType', 'any');
%! m = c.i_double;
%! assert(class(m), 'containers.Map');
%! assert(m.Count == 0);
%! c.i_double = [];
%! assert(isempty(c.i_double) && isnumeric(c.i_double));
%! c.s_string = struct('a', 'x', 'b', 'y');
%! m = c.s_string;
%! assert(m.keys(), {'a', 'b'});
%! assert(m('b'), 'y');
%! c.s_string = m;
%! assert(c.s_string('a'), 'x');
%! c.s_array = containers.Map({'k'}, {[1 2]}, 'UniformValues', false);
%! assert(c.s_array('k'), int32([1; 2]));
%! refused('s_string', containers.Map({'a'}, {5}), 'member s_string(''a''): expected string, got double');
%! refused('i_double', containers.Map({'a'}, {5}), 'member i_double: expected double{int32}, got containers.Map');

%!test % structs
%! s = struct('count', 2, 'text', 'x', 'numbers', [1 2], 'mode', 'running', 'next', [], 'extra', []);
%! c = bench();
%! c.report = s;
%! r = c.report;
%! assert(r.count, int32(2));
%! assert(r.numbers, [1; 2]);
%! assert(r.mode, int32(3));
%! assert(isempty(r.next));
%! assert(r.extra.datatype, 'null');
%! s.next = s;
%! c.report = s;
%! assert(c.report.next.count, int32(2));
%! c.report = [];
%! assert(isequal(c.report, []));
%! refused('report', rmfield(s, 'text'), 'member report: the field `text` of `experimental.bench.Report` is missing');
%! t = s;
%! t.more = 1;
%! refused('report', t, 'member report: `experimental.bench.Report` has no field `more`');
%! s.next.count = 'x';
%! refused('report', s, 'member report.next.count: expected int32, got char');
%! refused('report', [s, s], 'member report: expected experimental.bench.Report, got 1x2 struct');

%!test % lists of structs
%! s = struct('count', {1, 2}, 'text', 'x', 'numbers', [], 'mode', 0, 'next', [], 'extra', []);
%! c = bench();
%! c.l_report = {s(1), s(2)};
%! assert(c.l_report{2}.count, int32(2));
%! c.l_report = s;
%! assert(c.l_report{1}.count, int32(1));
%! c.l_report = {s(1), []};
%! assert(isempty(c.l_report{2}));

%!test % pods
%! s = struct('sequence', uint32(7), 'stamp', 0.5, 'acceleration', single([1; 2; 3]));
%! check('sample', s, s);
%! check('samples', [s, s], [s; s]);
%! check('samples', {s, s}, [s; s]);
%! c = bench();
%! c.samples = [];
%! assert(size(c.samples), [0 1]);
%! assert(fieldnames(c.samples), {'sequence'; 'stamp'; 'acceleration'});
%! grid = repmat(s, 2, 3);
%! grid(2, 1).sequence = uint32(9);
%! check('sample_grid', grid, grid);
%! check('l_sample', {s; s}, {s; s});
%! t = s;
%! t.acceleration = [1 2];
%! refused('sample', t, 'member sample, field acceleration: expected single[3], got 2 items');

%!test % namedarrays are numbers, in one dimension more
%! check('point', [1 2 3], [1; 2; 3]);
%! check('point', struct('x', 1, 'y', 2, 'z', 3), [1; 2; 3]);
%! check('points', [1 2; 3 4; 5 6], [1 2; 3 4; 5 6]);
%! check('points', [1; 2; 3], [1; 2; 3]);
%! check('points', [], zeros(3, 0));
%! check('point_grid', reshape(1:18, 3, 2, 3), reshape(1:18, 3, 2, 3));
%! check('pose', 1:7, (1:7)');
%! check('picture', uint8(reshape(1:12, 3, 2, 2)), uint8(reshape(1:12, 3, 2, 2)));
%! check('l_point', {[1; 2; 3]}, {[1; 2; 3]});
%! refused('point', [1 2], 'member point: expected experimental.bench.Vector3, which has 3 numbers, got 1x2 double');
%! refused('points', [1 2; 3 4], 'member points: expected experimental.bench.Vector3[], got double[*]');

%!test % varvalues tell their types
%! c = bench();
%! c.any = 5;
%! v = c.any;
%! assert(class(v), 'RobotRaconteurVarValue');
%! assert(v.datatype, 'double[]');
%! assert(v.data, 5);
%! check('any', RobotRaconteurVarValue([1 2], 'int16[]'), RobotRaconteurVarValue(int16([1; 2]), 'int16[]'));
%! check('any', 'text', RobotRaconteurVarValue('text', 'string'));
%! check('any', [], RobotRaconteurVarValue([], 'null'));
%! check('any', true, RobotRaconteurVarValue(true, 'bool[]'));
%! check('any', [1 2; 3 4], RobotRaconteurVarValue([1 2; 3 4], 'double[*]'));
%! s = struct('sequence', uint32(7), 'stamp', 0.5, 'acceleration', single([1; 2; 3]));
%! check('any', RobotRaconteurVarValue(s, 'experimental.bench.Sample[]'), ...
%!       RobotRaconteurVarValue(s, 'experimental.bench.Sample[]'));
%! c.any = RobotRaconteurVarValue([1 2 3], 'experimental.bench.Vector3');
%! assert(c.any.data, [1; 2; 3]);
%! c.any = {1, 'a'};
%! assert(c.any.datatype, 'varvalue{list}');
%! assert(c.any.data{2}.data, 'a');
%! c.l_any = {1; 'a'; []};
%! assert(c.l_any{2}.data, 'a');
%! assert(c.l_any{3}.datatype, 'null');
%! c.s_any = struct('a', int8(3));
%! assert(c.s_any('a').datatype, 'int8[]');
%! refused('any', RobotRaconteurVarValue(5, 'no.Type'), 'member any: no type: `no.Type`');
%! refused('any', RobotRaconteurVarValue('x', 'int16'), 'member any: expected int16, got char');
%! refused('any', @sin, 'member any: expected varvalue, got function_handle');
