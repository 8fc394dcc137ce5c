% SPDX-License-Identifier: Apache-2.0
% octave-cli --norc --path RULES check_rules.m TOP FOLDER...: holds the .m files of the folders, and of those
% below them, to what MATLAB documents. Fails for a file that does not keep to it. TOP is the runtime's folder.
1;

function files = files_below(folder)
  files = {};
  for entry = dir(folder)'
    path = fullfile(folder, entry.name);
    if entry.isdir
      if entry.name(1) ~= '.'
        files = [files, files_below(path)];
      end
    elseif numel(entry.name) > 2 && strcmp(entry.name(end - 1:end), '.m')
      files{end + 1} = path;
    end
  end
end

% Functions that a file defines, also as methods.
function names = defined_in(file)
  found = regexp(fileread(file), '(?m)^\s*function\s+(?:[^=\n]*=\s*)?(\w+)', 'tokens');
  names = cellfun(@(one) one{1}, found, 'UniformOutput', false);
end

% What other files may call: functions, classes, the first parts of packages, and methods of our own, which are
% told by their names; those that are called as a function of MATLAB are the object's in its own file only.
function names = seen_outside(file)
  [folder, name] = fileparts(file);
  names = [{name}, regexp(folder, '\+(\w+)', 'tokens', 'once')];
  methods_in = defined_in(file);
  names = [names, methods_in(strncmp(methods_in, 'rr_', 3) | strcmp(methods_in, 'to_array'))];
end

given = argv();
list = fullfile(given{1}, 'test', 'rules', 'matlab_functions.txt');
functions = regexp(fileread(list), '(?m)^([A-Za-z]\S*)\t(?:open|https://\S+)$', 'tokens');
functions = cellfun(@(one) one{1}, functions, 'UniformOutput', false);
files = {};
for k = 2:numel(given)
  if exist(given{k}, 'dir')
    files = [files, files_below(given{k})];
  else
    files{end + 1} = given{k};
  end
end
own = {'rrmex'};
for file = [files, files_below(fullfile(given{1}, 'toolbox'))]
  own = [own, seen_outside(file{1})];
end
own = unique(own);
open_list = fullfile(given{1}, 'test', 'rules', 'open.txt');
open_ones = regexp(fileread(open_list), '(?m)^([^#\t\n]+)\t(.+)$', 'tokens', 'dotexceptnewline');
is_met = false(size(open_ones));
faults = 0;
for file = files
  [~, name] = fileparts(file{1});
  findings = matlab_findings(fileread(file{1}), name, functions, ...
                             [own, defined_in(file{1})]);
  for finding = findings
    what = regexprep(finding{1}, '^\d+: ', '');
    is_open = cellfun(@(one) strcmp(one{1}, file{1}(max(1, end - numel(one{1}) + 1):end)) && ...
                      strncmp(one{2}, what, numel(one{2})), open_ones);
    is_met = is_met | is_open;
    if any(is_open)
      printf('open: ');
    else
      faults = faults + 1;
    end
    printf('%s:%s\n', file{1}, finding{1});
  end
end
for one = open_ones(~is_met)
  printf('no longer open: %s: %s\n', one{1}{1}, one{1}{2});
  faults = faults + 1;
end
printf('%d files, %d functions of MATLAB, %d faults\n', numel(files), numel(functions), faults);
exit(isempty(files) || isempty(functions) || faults ~= 0);
