function calls = rr_log_call(varargin)
%RR_LOG_CALL Without arguments: the calls since; with 'clear': forget them; else one call.
persistent kept
if isempty(kept)
  kept = {};
end
if nargin == 1 && ischar(varargin{1}) && strcmp(varargin{1}, 'clear')
  kept = {};
elseif nargin > 0
  kept{end + 1} = varargin;
end
calls = kept;
end
