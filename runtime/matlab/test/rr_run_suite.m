function rr_run_suite(suite, log)
%RR_RUN_SUITE Run the tests of a file; ends Octave with 1 when one has failed.
%   With generated classes, lines that end with `% by name` are left out: what a class does not have is
%   refused by the interpreter, in its own words.
if ~isempty(getenv('RR_TEST_CLASSES'))
  text = regexprep(fileread(suite), '[^\n]*% by name\n', '');
  [~, name, ending] = fileparts(suite);
  suite = fullfile(getenv('RR_TEST_FOLDER'), [name, ending]);
  file = fopen(suite, 'w');
  fputs(file, text);
  fclose(file);
end
[passed, all] = test(suite, 'quiet', log);
fprintf('%d passed, %d failed\n', passed, all - passed);
if passed ~= all || all == 0
  fprintf('%s', fileread(log));
end
exit(passed ~= all || all == 0);
end
