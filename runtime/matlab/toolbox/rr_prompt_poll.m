function rr_prompt_poll(varargin)
%RR_PROMPT_POLL Call the handlers of what has come, if there is a node.
rrmex('poll_prompt');
end
