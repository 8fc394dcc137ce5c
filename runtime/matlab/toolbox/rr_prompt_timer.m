function rr_prompt_timer(is_on)
%RR_PROMPT_TIMER Start or end the timer that calls handlers at MATLAB's prompt.
%   One timer does it for all objects. It is found by its name, since `clear all` takes variables away
%   but leaves timers running.
name = 'RobotRaconteurPrompt';
found = timerfindall('Name', name);
if is_on && isempty(found)
  % A handler that takes longer than the period is not called again meanwhile.
  found = timer('Name', name, 'ExecutionMode', 'fixedSpacing', 'Period', 0.05, ...
                'BusyMode', 'drop', 'ObjectVisibility', 'off', 'TimerFcn', @rr_prompt_poll);
  start(found);
elseif ~is_on && ~isempty(found)
  stop(found);
  delete(found);
end
end
