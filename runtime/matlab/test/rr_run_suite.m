function rr_run_suite(suite, log)
%RR_RUN_SUITE Run the tests of a file; ends Octave with 1 when one has failed.
[passed, all] = test(suite, 'quiet', log);
fprintf('%d passed, %d failed\n', passed, all - passed);
if passed ~= all || all == 0
  fprintf('%s', fileread(log));
end
exit(passed ~= all || all == 0);
end
