% The rules that check_rules.m holds the toolbox to find what they are there for.

%!function found = in_function(line)
%!  found = matlab_findings(sprintf('function f(a, b)\n%s\nend\n', line), 'f', {'numel', 'error'}, {'rr_show'});
%!endfunction

%!function refuses(line, what)
%!  found = in_function(line);
%!  assert(found, {['2: ', what]});
%!endfunction

%!assert(in_function('x = numel(a''); rr_show(b.y(1).numel2, [a'' ''text''], {a.'', 3e-5});'), {})
%!assert(in_function('error(''A:b'', ''100%% # "x" += !''); % endif # "'), {})
%!assert(in_function('f = @(x, y) x + y; [p, q] = f(a, ~b);  p(q) = 5; for k = q, k, end'), {})
%!assert(in_function('x = 1:3; y = x(end)''; z = {x, ''a''''b''}; if x ~= y, end'), {})
%!assert(in_function('x = {a, ... what ! is said here' ), {})
%!assert(in_function('printf(1)  % Octave'), {})
%!test refuses('# old', 'a comment that begins with #')
%!test refuses('x = "text";', 'a text in double quotes, which is of another class in MATLAB')
%!test refuses('x = !a;', 'the operator !, which MATLAB does not have')
%!test refuses('x = a != b;', 'the operator !=, which MATLAB does not have')
%!test refuses('a += 1;', 'the operator +=, which MATLAB does not have')
%!test refuses('a++;', 'the operator ++, which MATLAB does not have')
%!test refuses('if a, b = 1; endif', 'endif, which only Octave has')
%!test refuses('unwind_protect', 'unwind_protect, which only Octave has')
%!test refuses('x = numel(a)(1);', 'an index behind parentheses')
%!test refuses('x = numel(a){1};', 'an index behind parentheses')
%!assert(in_function('x = a{1}{2}; y = a{1}(2);'), {})
%!test refuses('printf(a);', '`printf` is no function of MATLAB that is known here')
%!test refuses('x = @puts;', '`puts` is no function of MATLAB that is known here')
%!test refuses('error(''a.b:c'', a);', '`a.b:c` is no identifier as MATLAB documents them')
%!test refuses('x = ''a:2b'';', '`a:2b` is no identifier as MATLAB documents them')
%!test refuses(['x.', repmat('a', 1, 64), ' = 1;'], ['a name of more than 63 letters: ', repmat('a', 1, 64)])
%!test refuses('import a.b', 'import, which Octave does not have')
%!assert(matlab_findings(sprintf('function g()\nend\n'), 'f', {}, {}), ...
%!  {'1: the first function is not called as its file'})
%!assert(matlab_findings(sprintf('classdef g < handle\nend\n'), 'f', {}, {'handle'}), ...
%!  {'1: the class is not called as its file'})
%!assert(matlab_findings(sprintf('classdef f < handle\nproperties (Sealed)\nend\nenumeration\nend\nend\n'), 'f', {}, ...
%!  {}), {'2: the attribute Sealed', '4: a block of enumeration, which Octave does not have'})
%!assert(matlab_findings(sprintf('x = 1;\n'), 'f', {}, {}), ...
%!  {'1: a script, which could not be told from a function by its use'})
