function findings = matlab_findings(text, name, functions, own)
%MATLAB_FINDINGS What MATLAB's documented rules have against a file: cells of `line: what`.
%   text is the file's, name its name without .m; functions are the names that MATLAB has, own those that the
%   toolbox and the files beside it define. A file may use functions of Octave in a line that ends with
%   `% Octave`, where the line is reached in Octave only.
findings = {};
lines = strsplit(text, char(10));
words = {};
calls = {};
places = [];
block = '';
is_class = false;
first_function = '';
joined = {};
for number = 1:numel(lines)
  line = strtrim(lines{number});
  if isempty(joined) && (isempty(line) || strcmp(line, 'end') || line(1) == '%')
    continue  % most lines; quickly
  end
  tokens = matlab_tokens(line);
  is_space = cellfun(@(one) isspace(one(1)), tokens);
  report = @(what) sprintf('%d: %s', number, what);
  if ~isempty(regexp(line, '% Octave$', 'once'))
    continue
  end
  findings = [findings, cellfun(report, signs_of(tokens), 'UniformOutput', false)];
  code = tokens(~is_space);
  is_continued = ~isempty(code) && strncmp(code{end}, '...', 3);
  code = code(~cellfun(@(one) any(one(1) == '%#') || strncmp(one, '...', 3), code));
  joined = [joined, code];
  if is_continued || isempty(joined)
    continue
  end
  statement = joined;
  joined = {};
  switch statement{1}
    case 'classdef'
      is_class = true;
      if ~any(strcmp(statement, name))
        findings{end + 1} = report('the class is not called as its file');
      end
      block = 'classdef';
      continue
    case {'properties', 'methods', 'enumeration', 'events'}
      block = statement{1};
      findings = [findings, cellfun(report, attributes_of(statement), 'UniformOutput', false)];
      continue
    case 'function'
      block = 'function';
      [made, called] = signature_of(statement);
      words = [words, made];
      if isempty(first_function)
        first_function = called;
        if ~is_class && ~strcmp(called, name)
          findings{end + 1} = report('the first function is not called as its file');
        end
      end
      continue
    case 'import'
      findings{end + 1} = report('import, which Octave does not have');
      continue
  end
  if strcmp(block, 'properties') && ~strcmp(statement{1}, 'end')
    words(end + 1) = statement(1);
    statement(1) = [];
    if isempty(statement)
      continue
    end
  end
  if any(ismember(statement, {';', ','}))
    parts = parts_of(statement);
  else
    parts = {statement};
  end
  for one = parts
    [made, called] = names_of(one{1});
    words = [words, made];
    calls = [calls, called];
    places = [places, repmat(number, 1, numel(called))];
  end
end
if isempty(first_function) && ~is_class
  findings{end + 1} = '1: a script, which could not be told from a function by its use';
end
for k = find(~ismember(calls, [words, functions, own, {name}]))
  findings{end + 1} = sprintf('%d: `%s` is no function of MATLAB that is known here', places(k), calls{k});
end
end

function found = signs_of(tokens)
% What is wrong with single tokens, and with two behind each other.
found = {};
if isempty(tokens)
  return
end
first = cellfun(@(one) one(1), tokens);
is_operator = ismember(tokens, {'!', '!=', '+=', '-=', '*=', '/=', '^=', '|=', '&=', '++', '--', '**'});
is_keyword = first >= 'a' & ismember(tokens, octave_keywords());
is_index = [false, first(1:end - 1) == ')' & (first(2:end) == '(' | first(2:end) == '{')];
is_long = isletter(first) & cellfun(@numel, tokens) > 63;
for k = find(is_operator | is_keyword | is_index | is_long | ismember(first, '#"''_'))
  one = tokens{k};
  if one(1) == '#'
    found{end + 1} = 'a comment that begins with #';
  elseif one(1) == '"'
    found{end + 1} = 'a text in double quotes, which is of another class in MATLAB';
  elseif is_operator(k)
    found{end + 1} = sprintf('the operator %s, which MATLAB does not have', one);
  elseif is_keyword(k)
    found{end + 1} = sprintf('%s, which only Octave has', one);
  elseif is_index(k)
    found{end + 1} = 'an index behind parentheses';
  elseif is_long(k)
    found{end + 1} = sprintf('a name of more than 63 letters: %s', one);
  elseif one(1) == '_'
    found{end + 1} = sprintf('a name that begins with _: %s', one);
  else
    found = [found, identifier_in(one(2:end - 1))];
  end
end
end

function found = identifier_in(text)
% A text that is meant as the identifier of an error.
found = {};
if ~isempty(regexp(text, '^[\w.-]+(:[\w.-]+)+$', 'once')) && ...
   isempty(regexp(text, '^[A-Za-z]\w*(:[A-Za-z]\w*)+$', 'once'))
  found = {sprintf('`%s` is no identifier as MATLAB documents them', text)};
end
end

function found = attributes_of(statement)
% Of `properties (...)` and the like: those that both have.
found = {};
known = {'Access', 'Constant', 'Dependent', 'GetAccess', 'Hidden', 'SetAccess', 'Static', 'private', 'public', ...
         'true', 'false', 'protected', 'immutable'};
for k = 2:numel(statement)
  if isletter(statement{k}(1)) && ~any(strcmp(statement{k}, known))
    found{end + 1} = sprintf('the attribute %s', statement{k});
  end
end
if any(strcmp(statement{1}, {'enumeration', 'events'}))
  found{end + 1} = sprintf('a block of %s, which Octave does not have', statement{1});
end
end

function [made, called] = signature_of(statement)
% The names in `function [a, b] = name(c, d)`.
is_word = cellfun(@(one) isletter(one(1)), statement);
is_word(1) = false;
made = statement(is_word);
equals = [find(strcmp(statement, '=')), 1];
called = statement{equals(1) + 1};
end

function [made, called] = names_of(statement)
% The variables that a statement makes, and all other names in it but those behind a dot.
made = {};
equals = top_level(statement, '=');
if strcmp(statement{1}, 'catch') || any(strcmp(statement{1}, {'persistent', 'global'}))
  made = statement(2:end);
  called = {};
  return
end
if strcmp(statement{1}, 'for')
  made = statement(2);
elseif ~isempty(equals) && equals(1) > 1
  left = statement(1:equals(1) - 1);
  if strcmp(left{1}, '[')
    made = left([false, cellfun(@(one) any(strcmp(one, {'[', ','})), left(1:end - 1))]);
  else
    made = left(1);
  end
end
called = {};
k = 1;
while k <= numel(statement)
  one = statement{k};
  is_behind_dot = k > 1 && strcmp(statement{k - 1}, '.');
  if strcmp(one, '@') && k < numel(statement) && strcmp(statement{k + 1}, '(')
    while ~strcmp(statement{k}, ')')
      if isletter(statement{k}(1))
        made(end + 1) = statement(k);
      end
      k = k + 1;
    end
  elseif isletter(one(1)) && ~is_behind_dot && ~any(strcmp(one, [matlab_keywords(), octave_keywords()]))
    called(end + 1) = {one};
  end
  k = k + 1;
end
end

function parts = parts_of(statement)
% The statements of a line, of which each ends with a sign outside all brackets.
ends = unique([top_level(statement, ';'), top_level(statement, ','), numel(statement) + 1]);
parts = {};
begin = 1;
for last = ends
  if last > begin
    parts{end + 1} = statement(begin:last - 1);
  end
  begin = last + 1;
end
end

function found = top_level(statement, sign)
% Where a sign is outside all brackets.
depth = cumsum(ismember(statement, {'(', '[', '{'}) - ismember(statement, {')', ']', '}'}));
found = reshape(find(depth == 0 & strcmp(statement, sign)), 1, []);
end

function words = octave_keywords()
words = {'__FILE__', '__LINE__', 'do', 'until', 'endfor', 'endfunction', 'endif', 'endswitch', 'endwhile', ...
         'end_try_catch', 'end_unwind_protect', 'unwind_protect', 'unwind_protect_cleanup', 'endclassdef', ...
         'endmethods', 'endproperties', 'endenumeration', 'endevents', 'endparfor', 'endspmd'};
end

function words = matlab_keywords()
words = {'break', 'case', 'catch', 'classdef', 'continue', 'else', 'elseif', 'end', 'for', 'function', 'global', ...
         'if', 'otherwise', 'parfor', 'persistent', 'return', 'spmd', 'switch', 'try', 'while'};
end
