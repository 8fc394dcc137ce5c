% SPDX-License-Identifier: Apache-2.0
% octave-cli --norc --path TOOLBOX parse_generated.m FOLDER...: reads all files. Fails for a
% file that Octave does not parse, or parses with a warning.
1;

function files = files_below(folder)
  files = {};
  for entry = dir(folder)'
    path = fullfile(folder, entry.name);
    if entry.isdir
      if entry.name(1) ~= '.'
        files = [files; files_below(path)];
      end
    elseif numel(entry.name) > 2 && strcmp(entry.name(end - 1:end), '.m')
      files{end + 1, 1} = path;
    end
  end
end

function fault = fault_of(file)
  fault = '';
  lastwarn('');
  try
    __parse_file__(file);
    fault = lastwarn();
  catch err
    fault = err.message;
  end
end

folders = argv();
files = {};
for k = 1:numel(folders)
  files = [files; files_below(folders{k})];
end
faults = 0;
for k = 1:numel(files)
  fault = fault_of(files{k});
  if ~isempty(fault)
    printf('%s: %s\n', files{k}, fault);
    faults = faults + 1;
  end
end
printf('%d files, %d with faults\n', numel(files), faults);
exit(isempty(files) || faults ~= 0);
