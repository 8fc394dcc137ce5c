function items = rr_memory_pick(items, count, picked, given)
%RR_MEMORY_PICK What was asked for of a box that was read: an array, as indexing gives.
if isa(items, 'RobotRaconteurMultiDimArray')
  items = to_array(items);
end
extra = ndims_of_item(items, count);
if any(~cellfun(@isempty, picked))
  subs = repmat({':'}, 1, numel(count));
  for i = 1:numel(count)
    if ~isempty(picked{i})
      subs{i} = picked{i};
    end
  end
  items = items(extra{:}, subs{:});
end
if given == 1 && numel(count) > 1
  items = reshape(items, [], 1);
end
end

function extra = ndims_of_item(items, count)
% Numbers of a namedarray come first, in a dimension of their own.
extra = {};
if ~isstruct(items) && numel(items) ~= prod(count)
  extra = {':'};
end
end
