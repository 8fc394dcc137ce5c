% The table of types in docs/matlab.md, each row in both directions.

%!function c = bench()
%!  persistent kept
%!  if isempty(kept)
%!    kept = rr_bench();
%!  end
%!  c = kept;
%!endfunction

%!function check(name, given, wanted)
%!  c = bench();
%!  c.(name) = given;
%!  got = c.(name);
%!  assert(rr_isequal(got, wanted), 'as %s', evalc('display(got)'));
%!  c.(name) = got;
%!  assert(rr_isequal(c.(name), wanted));
%!endfunction

%!function refused(name, given, text)
%!  c = bench();
%!  try
%!    c.(name) = given;
%!  catch err
%!    assert(err.identifier, 'RobotRaconteur:DataTypeMismatch');
%!    assert(strcmp(err.message, text), 'says %s', err.message);
%!    return
%!  end
%!  error('taken');
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

%!test % complex numbers keep the signs of their zeros
%! c = bench();
%! c.v_cdouble = complex(-0, -0);
%! assert([1 / real(c.v_cdouble), 1 / imag(c.v_cdouble)], [-Inf -Inf]);
%! c.v_csingle = c.v_cdouble;
%! assert([1 / real(c.v_csingle), 1 / imag(c.v_csingle)], single([-Inf -Inf]));
%! c.m_cdouble = complex([0 -0; 1 2], [-0 0; -0 0]);
%! c.m_cdouble = c.m_cdouble;
%! assert(1 ./ imag(c.m_cdouble), [-Inf Inf; -Inf Inf]);
%! assert(1 ./ real(c.m_cdouble), [Inf -Inf; 1 0.5]);
%! c.l_cdouble = {complex(1, -0)};
%! kept.field = c.l_cdouble;
%! c.l_cdouble = kept.field;
%! assert(1 / imag(c.l_cdouble{1}), -Inf);

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

%!function a = shaped(varargin)
%!  a = RobotRaconteurMultiDimArray(varargin{:});
%!endfunction

%!test % arrays of sizes that the interpreter does not keep
%! check('m_single', struct('dims', [2 2 1], 'array', [1 2 3 4]), shaped([2 2 1], single(1:4)));
%! check('m_single', struct('dims', [2 2], 'array', [1 2 3 4]), single([1 3; 2 4]));
%! check('m_single', shaped([2 3], 1:6), single([1 3 5; 2 4 6]));
%! for dims = {[], 0, 1, 3, [1 1 1 1], [2 3 1], [0 0 1], [2 0 1 1], [1 4 1]}
%!   count = prod(dims{1}) * ~isempty(dims{1});
%!   check('m_single', shaped(dims{1}, 1:count), shaped(dims{1}, single(1:count)));
%!   check('m_bool', shaped(dims{1}, ones(1, count)), shaped(dims{1}, true(count, 1)));
%!   check('m_cdouble', shaped(dims{1}, 1:count), shaped(dims{1}, complex(1:count, 0)));
%! end
%! huge = [4294967295 4294967295 4294967295 0];
%! check('m_single', shaped(huge, []), shaped(huge, single([])));
%! check('l_grid', {shaped([1 2 1], [5 6]), [1 2]}, {shaped([1 2 1], single([5 6])); single([1 2])});
%! check('s_grid', struct('a', shaped(2, [5 6])), ...
%!       containers.Map({'a'}, {shaped(2, single([5 6]))}, 'UniformValues', false));
%! check('any', shaped([1 1 1], 5), RobotRaconteurVarValue(shaped([1 1 1], 5), 'double[*]'));
%! check('any', shaped(2, int8([5 6])), RobotRaconteurVarValue(shaped(2, int8([5 6])), 'int8[*]'));
%! check('any', shaped(1, complex(1, 0)), RobotRaconteurVarValue(shaped(1, complex(1, 0)), 'cdouble[*]'));
%! check('any', RobotRaconteurVarValue(shaped(2, [5 6]), 'int16[*]'), ...
%!       RobotRaconteurVarValue(shaped(2, int16([5 6])), 'int16[*]'));
%! check('m_fixed', shaped([2 3], 1:6), int32([1 3 5; 2 4 6]));
%! check('a_double', shaped(2, [5 6]), [5; 6]);
%! refused('a_double', shaped([2 1], [5 6]), 'member a_double: expected double[], got RobotRaconteurMultiDimArray');
%! refused('m_fixed', shaped([2 3 1], 1:6), 'member m_fixed: expected int32[2,3], got 2x3x1');
%! refused('m_single', struct('dims', [2 2 1], 'array', 1:3), 'member m_single: expected 4 items, got 3');
%! refused('point_grid', struct('dims', [], 'array', 1:3), 'member point_grid: expected 0 items for dims , got 1');
%! refused('point_grid', struct('dims', [2 1], 'array', 1:3), 'member point_grid: expected 6 items, got 3');
%! refused('m_single', struct('dims', [65536 65536 65536 65536], 'array', 1), 'member m_single: too many items');
%! refused('m_single', struct('dims', [2 -1], 'array', 1), 'member m_single.dims(2): uint32 cannot hold -1');
%! refused('m_single', struct('dims', [1 1 1], 'array', 'x'), 'member m_single.array: expected single[], got char');
%! refused('any', shaped([1 1 1], 'x'), 'member any: expected varvalue, got char');

%!test % the same of pods and namedarrays
%! s = struct('sequence', uint32(7), 'stamp', 0.5, 'acceleration', single([1; 2; 3]));
%! check('sample_grid', shaped([2 1 1], [s; s]), shaped([2 1 1], [s; s]));
%! check('sample_grid', shaped([2 1 1], {s; s}), shaped([2 1 1], [s; s]));
%! check('sample_grid', shaped(1, s), shaped(1, s));
%! check('sample_grid', shaped([], repmat(s, 0, 1)), shaped([], repmat(s, 0, 1)));
%! check('sample_grid', struct('dims', 2, 'array', {[s s]}), shaped(2, [s; s]));
%! check('point_grid', shaped([2 1], reshape(1:6, 3, 2)), shaped([2 1], reshape(1:6, 3, 2)));
%! check('point_grid', shaped([1 1], [1; 2; 3]), shaped([1 1], [1; 2; 3]));
%! check('point_grid', struct('dims', [2 1], 'array', 1:6), shaped([2 1], reshape(1:6, 3, 2)));
%! check('point_grid', shaped([0 1], zeros(3, 0)), shaped([0 1], zeros(3, 0), 3));
%! check('point_grid', shaped([], zeros(3, 0)), shaped([], zeros(3, 0), 3));
%! check('point_grid', shaped(2, reshape(1:6, 3, 2)), reshape(1:6, 3, 2));
%! c = bench();
%! c.point_grid = shaped([2 1], reshape(1:6, 3, 2));
%! assert(size(c.point_grid), [3 2 1]);
%! assert(c.point_grid(:, 2), [4; 5; 6]);
%! boxes = struct('dims', {int32(1); int32(2)}, 'array', {0.5; 1.5});
%! check('boxes', repmat(boxes, 1, 2), repmat(boxes, 1, 2));
%! check('boxes', boxes(1), boxes(1));
%! check('boxes', shaped([1 2 1], boxes), shaped([1 2 1], boxes));
%! check('boxes', shaped(1, boxes(2)), shaped(1, boxes(2)));

%!test % in structs, of functions and wires
%! s = struct('sequence', uint32(7), 'stamp', 0.5, 'acceleration', single([1; 2; 3]));
%! given = struct('picture', shaped([2 3 1], uint8(1:6)), 'samples', shaped(1, s), ...
%!   'points', shaped([1 1], [1; 2; 3]), 'gain', complex(1, -0), 'gains', shaped(2, complex([1; 2], -0)), ...
%!   'limits', RobotRaconteurMap({''}, {5}), 'extra', RobotRaconteurVarValue(shaped(1, 2), 'double[*]'));
%! check('shapes', given, given);
%! c = bench();
%! assert(1 / imag(c.shapes.gain), -Inf);
%! assert(1 ./ imag(c.shapes.gains.array), [-Inf; -Inf]);
%! check('any', RobotRaconteurVarValue(given, 'experimental.bench.Shapes'), ...
%!       RobotRaconteurVarValue(given, 'experimental.bench.Shapes'));
%! assert(rr_isequal(c.same(shaped([2 1 1], [3 4])), shaped([2 1 1], uint8([3 4]))));
%! assert(c.same([3 4]), uint8([3 4]));
%! w = c.frame;
%! w.PokeOutValue(shaped([2 3 1], 1:6));
%! assert(rr_isequal(w.PeekOutValue(), shaped([2 3 1], uint8(1:6))));

%!test % they are used as arrays
%! a = shaped([2 3 1], 1:6);
%! [h, w, n] = size(a);
%! assert([h w n], [2 3 1]);
%! assert(size(a), [2 3 1]);
%! assert([size(a, 2), size(a, 3), size(a, 4)], [3 1 1]);
%! [h, w] = size(shaped([2 3 4 1], 1:24));
%! assert([h w], [2 12]);
%! assert({numel(a), ndims(a), length(a), rows(a), columns(a)}, {6, 3, 3, 2, 3});
%! assert({isempty(a), isempty(shaped([], []))}, {false, true});
%! assert({size(shaped([], [])), size(shaped([], zeros(3, 0), 3)), size(shaped(0, []))}, {[0 0], [3 0], [0 1]});
%! assert(isequal(shaped([], []), []));
%! assert({isnumeric(a), isfloat(a), islogical(a), isreal(a)}, {true, true, false, true});
%! assert(a(:, :, 1), [1 3 5; 2 4 6]);
%! assert({a(2, 3), a(2, 3, 1), a(end), a(end, 1), a(end, end, end)}, {6, 6, 6, 2, 6});
%! assert(a(:), (1:6)');
%! assert(to_array(a), [1 3 5; 2 4 6]);
%! assert(class(uint8(a)), 'uint8');
%! assert({a + 1, 1 + a, a .* a, -a}, {[2 4 6; 3 5 7], [2 4 6; 3 5 7], [1 9 25; 4 16 36], -[1 3 5; 2 4 6]});
%! assert(a', [1 2; 3 4; 5 6]);
%! assert(a == [1 3 5; 2 4 6], true(2, 3));
%! assert(isequal(a, [1 3 5; 2 4 6]) && isequal([1 3 5; 2 4 6], a) && ~isequal(a, 1));
%! assert({sum(a), max(a, [], 2), mean(a(:))}, {[3 7 11], [5; 6], 3.5});
%! a(2, 2) = 40;
%! assert(rr_isequal(a, shaped([2 3 1], [1 2 3 40 5 6])));
%! a(:, 4, 1) = [7; 8];
%! assert(rr_isequal(a, shaped([2 4 1], [1 2 3 40 5 6 7 8])));
%! b = shaped(2, [5 6]);
%! b(3) = 7;
%! assert(rr_isequal(b, shaped(3, 5:7)));
%! kept = {struct('a', b)};
%! assert(kept{1}.a(2), 6);
%! assert(kept{1}.a.dims, 3);
%! assert(size(b), [3 1]);
%! assert(~isempty(strfind(evalc('b'), '3x1 double')));
%! c = bench();
%! c.m_single = a;
%! assert(~isempty(strfind(evalc('disp(c)'), 'm_single = [1 3 5 7;2 40 6 8]')));
%! c.m_single(1, 1) = 9;
%! assert(c.m_single(1), single(9));
%! assert(c.m_single.dims, [2 4 1]);

%!error <expected 4 items, got 3> RobotRaconteurMultiDimArray([2 2], 1:3)
%!error id=RobotRaconteur:InvalidArgument RobotRaconteurMultiDimArray([2 2])
%!error <make a new>
%! a = RobotRaconteurMultiDimArray([1 1 1], 5);
%! a.dims = [3 1];

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

%!test % maps with an empty key
%! check('s_int32', RobotRaconteurMap({'', 'a'}, {1, 2}), RobotRaconteurMap({'', 'a'}, {int32(1), int32(2)}));
%! check('s_int32', RobotRaconteurMap({'a'}, {2}), containers.Map({'a'}, {int32(2)}, 'UniformValues', false));
%! c = bench();
%! c.s_int32 = RobotRaconteurMap();
%! assert(c.s_int32.Count == 0);
%! check('s_string', RobotRaconteurMap('', 'x'), RobotRaconteurMap('', 'x'));
%! check('any', RobotRaconteurMap('', 5), RobotRaconteurVarValue( ...
%!   RobotRaconteurMap('', RobotRaconteurVarValue(5, 'double[]')), 'varvalue{string}'));
%! refused('s_int32', RobotRaconteurMap('', 'x'), 'member s_int32(''''): expected int32, got char');
%! refused('i_double', RobotRaconteurMap('', 5), 'member i_double: expected double{int32}, got RobotRaconteurMap');
%! c.s_int32 = RobotRaconteurMap({'', 'b'}, {1, 2});
%! assert(c.s_int32(''), int32(1));
%! m = c.s_int32;
%! assert(all([m.Count, m.length(), numel(m), 2 + isempty(m)] == 2));
%! assert(m.keys(), {'', 'b'});
%! assert(m.values(), {int32(1), int32(2)});
%! assert(values(m, {'b'}), {int32(2)});
%! assert({m.isKey(''), isKey(m, 'c'), isKey(m, 5)}, {true, false, false});
%! assert(isKey(m, {'', 'b', 'c'}), [true true false]);
%! assert({m.KeyType, m.ValueType}, {'char', 'any'});
%! m('c') = [1 2];
%! assert(m('c')(2), 2);
%! m.remove('c');
%! remove(m, '');
%! assert(keys(m), {'b'});
%! assert(~isempty(strfind(evalc('m'), 'RobotRaconteurMap')));
%! assert(isequal(m, RobotRaconteurMap('b', int32(2))));
%! assert(~isequal(m, RobotRaconteurMap('b', int32(3))));
%! m('') = 3;
%! other = m;
%! other('') = 4;
%! assert(m(''), 4);

%!test % keys of all kinds
%! c = bench();
%! for more = {{}, {''}}
%!   all = [{' ', 'a ', "a\0", "\n", char([255 254]), "\0", '1', 'for', 'a', 'A', repmat('x', 1, 300)}, more{1}];
%!   c.s_int32 = RobotRaconteurMap(all, num2cell(1:numel(all)));
%!   c.s_int32 = c.s_int32;
%!   m = c.s_int32;
%!   assert(numel(keys(m)), numel(all));
%!   for i = 1:numel(all)
%!     assert(m(all{i}), int32(i));
%!   end
%! end

%!error <does not exist> RobotRaconteurMap({'a'}, {1})('')
%!error id=RobotRaconteur:InvalidArgument RobotRaconteurMap({'a'}, {1})(5)
%!error id=RobotRaconteur:InvalidArgument RobotRaconteurMap({'a', 'b'}, {1})

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

%!function size = resident()
%!  size = str2double(regexp(fileread('/proc/self/status'), 'VmRSS:\s+(\d+)', 'tokens'){1}{1}) / 1024;
%!endfunction

%!test % what objects of the toolbox's classes hold is let go of
%! c = bench();
%! for i = 1:60
%!   if i == 10
%!     before = resident();
%!   end
%!   c.m_single = RobotRaconteurMultiDimArray([2^18 1 1], i * ones(2^18, 1, 'single'));
%!   c.any = RobotRaconteurVarValue(i * ones(2^17, 1), 'double[]');
%! end
%! assert(resident() - before < 40);
