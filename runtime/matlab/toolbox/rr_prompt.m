function rr_prompt(is_on)
%RR_PROMPT Have handlers called while the prompt waits, or no longer.
persistent hook
if ~exist('OCTAVE_VERSION', 'builtin')
  rr_prompt_timer(is_on);
elseif is_on && isempty(hook) && exist('add_input_event_hook', 'builtin')
  hook = add_input_event_hook(@rr_prompt_poll);  % Octave
elseif ~is_on && ~isempty(hook)
  remove_input_event_hook(hook);  % Octave
  hook = [];
end
end
