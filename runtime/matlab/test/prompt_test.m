% Handlers at the prompt: in MATLAB from a timer, for which a class in stand_in stands, and in Octave while it
% waits for input.

%!function use_stand_in()
%!  addpath(fullfile(fileparts(which('rr_serve')), 'stand_in'));
%!endfunction

%!test % one timer calls handlers, until it is ended
%! use_stand_in();
%! rr_prompt_timer(true);
%! rr_prompt_timer(true);
%! assert(numel(timer_list()), 1);
%! t = timer_list(){1};
%! assert(t.Running, 'on');
%! assert(t.ExecutionMode, 'fixedSpacing');
%! assert(t.BusyMode, 'drop');
%! assert(t.Period > 0 && t.Period <= 0.1);
%! c = rr_bench();
%! rr_log_call('clear');
%! l = addlistener(c, 'fired', @(number, text) rr_log_call(number));
%! c.fire(2);
%! start = tic();
%! while numel(rr_log_call()) < 2 && toc(start) < 20
%!   t.Fire();
%! end
%! assert(rr_log_call(), {{int32(1)}, {int32(2)}});
%! delete(l);
%! rr_prompt_timer(false);
%! assert(t.Running, 'off');
%! assert(timer_list(), {});
%! rr_prompt_timer(false);

%!test % a timer that outlives `clear` is found again
%! use_stand_in();
%! rr_prompt_timer(true);
%! clear rr_prompt_timer
%! rr_prompt_timer(true);
%! assert(numel(timer_list()), 1);
%! rr_prompt_timer(false);

%!test % a handler that fails does not stop the timer
%! use_stand_in();
%! c = rr_bench();
%! rr_prompt_timer(true);
%! t = timer_list(){1};
%! rr_log_call('clear');
%! l = addlistener(c, 'fired', @(number, text) error('some:id', 'bad'));
%! r = addlistener(c, 'reported', @(report) rr_log_call(report.count));
%! c.fire(1);
%! c.stop();
%! evalc('start = tic(); while isempty(rr_log_call()) && toc(start) < 20, t.Fire(); end');
%! assert(rr_log_call(), {{int32(1)}});
%! assert(t.Running, 'on');
%! delete(l);
%! delete(r);
%! rr_prompt_timer(false);

%!test % without a node nothing is made by looking
%! use_stand_in();
%! RobotRaconteur.Shutdown();
%! rr_prompt_timer(true);
%! timer_list(){1}.Fire();
%! RobotRaconteur.SetNodeOptions(struct());  % refused once there is a node
%! rr_prompt_timer(false);

%!test % Octave has no timer, and is never asked for one
%! use_stand_in();
%! c = rr_bench();
%! RobotRaconteur.EnableEvents(c);
%! RobotRaconteur.EnableEvents(c);
%! assert(timer_list(), {});
%! RobotRaconteur.Shutdown();
