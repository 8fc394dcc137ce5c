function items = rr_memory_shape(items, count)
%RR_MEMORY_SHAPE Items for a box of a memory, in its sizes: one for all, or as many as it has.
total = prod(count);
if isa(items, 'RobotRaconteurMultiDimArray')
  items = to_array(items);
end
if numel(items) == 1 && total ~= 1 && ~isstruct(items)
  items = repmat(items, [count, 1]);
end
numbers = numel(items) / max(total, 1);  % of each namedarray
if numbers ~= fix(numbers) || (numbers == 0) ~= (total == 0)
  error('RobotRaconteur:InvalidArgument', 'expected %d items, got %d', total, numel(items));
end
items = RobotRaconteurMultiDimArray(count, items, numbers * (numbers > 1));
end
