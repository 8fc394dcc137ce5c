function count = rr_result_count(value, s)
%RR_RESULT_COUNT How many results a statement has that refers to s behind a value: 0 or 1.
if isa(value, 'RobotRaconteurObject')
  count = max(rrmex('result_count', value, s.subs), 0);
  return
end
% Methods of the toolbox's classes that give nothing.
last = s(max([1, find(strcmp({s.type}, '.'), 1, 'last')]));
count = double(~strcmp(last.type, '.') || ~any(strcmp(last.subs, ...
  {'PokeOutValue', 'Close', 'Abort', 'async_Next', 'SetQueueLimit', 'Write', 'delete', 'disp'})));
end
