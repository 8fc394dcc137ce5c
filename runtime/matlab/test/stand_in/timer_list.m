function found = timer_list(one, what)
%TIMER_LIST The timers that there are, in a cell array; adds or removes one first.
persistent all
if isempty(all)
  all = {};
end
if nargin == 1
  all{end + 1} = one;
elseif nargin == 2
  all(cellfun(@(other) strcmp(other.Name, one.Name), all)) = [];
end
found = all;
end
