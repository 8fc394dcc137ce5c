function [first, count, picked] = rr_memory_ranges(s, memory)
%RR_MEMORY_RANGES The box that indexes mean, and for each dimension with gaps which of it.
%   picked{i} is empty for a dimension without gaps. A single index of a memory of several
%   dimensions has to be `:`.
if ~strcmp(s.type, '()')
  error('RobotRaconteur:InvalidArgument', 'a memory is indexed by parentheses');
end
subs = s.subs;
dims = Inf;  % the service says what lies outside
if ~rr_says_all(subs, memory)
  dims = rrmex('memory_dims', memory.rr_object, memory.rr_name);
end
rank = numel(dims);
is_all = @(x) ischar(x) && strcmp(x, ':');
if numel(subs) == 1 && rank > 1 && is_all(subs{1})
  subs = repmat({':'}, 1, rank);
end
while numel(subs) > rank && rr_is_one(subs{end})
  subs(end) = [];
end
if numel(subs) ~= rank
  error('RobotRaconteur:InvalidArgument', 'the memory has %d dimensions', rank);
end
first = ones(1, rank);
count = dims;
picked = cell(1, rank);
for i = 1:rank
  index = subs{i};
  if is_all(index)
    continue
  end
  if islogical(index)
    index = find(index);
  end
  index = double(index(:).');
  if isempty(index)
    count(i) = 0;
    continue
  end
  if any(index < 1 | index > dims(i) | index ~= fix(index))
    error('RobotRaconteur:OutOfRange', 'index %d of the memory goes from 1 to %d', i, dims(i));
  end
  first(i) = min(index);
  count(i) = max(index) - first(i) + 1;
  if ~isequal(index, first(i):max(index))
    picked{i} = index - first(i) + 1;
  end
end
end

function answer = rr_says_all(subs, memory)
% Whether the service need not be asked how large the memory is.
answer = numel(subs) == 1 && isnumeric(subs{1}) && ~isempty(subs{1}) && ...
         all(subs{1}(:) >= 1 & subs{1}(:) == fix(subs{1}(:))) && ...
         rrmex('memory_is_flat', memory.rr_object, memory.rr_name);
end

function answer = rr_is_one(index)
answer = (ischar(index) && strcmp(index, ':')) || isequal(double(index), 1);
end
