function outcome = conformance_outcome(outcomes, call)
%CONFORMANCE_OUTCOME What the call of this number, counted from 1, is to give: of a list the one at its
%   place, or the last; what is no list is for all.
outcome = outcomes;
if iscell(outcomes)
  outcome = [];
  if ~isempty(outcomes)
    outcome = outcomes{min(call, numel(outcomes))};
  end
end
end
