% Values that the interpreter's own arrays and maps do not keep, in both directions.

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
