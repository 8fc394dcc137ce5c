function [failure, result] = rr_run_handler(handler, given, wants_result)
%RR_RUN_HANDLER Call a user's function for the MEX file, and tell how it failed.
failure = [];
result = [];
try
  if wants_result
    result = feval(handler, given{:});
  else
    feval(handler, given{:});
  end
catch err
  failure = struct('identifier', err.identifier, 'message', err.message);
end
end
