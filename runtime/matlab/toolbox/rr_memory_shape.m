function items = rr_memory_shape(items, count, has_dims)
%RR_MEMORY_SHAPE Items for a box of a memory: one for all, or as many as it has.
total = prod(count);
if isa(items, 'RobotRaconteurMultiDimArray')
  items = to_array(items);
end
if numel(items) == 1 && total ~= 1 && ~isstruct(items)
  items = repmat(items, [count, 1]);
end
if ~has_dims
  return
end
if numel(items) ~= total && (total == 0 || mod(numel(items), total) ~= 0)
  error('RobotRaconteur:InvalidArgument', 'expected %d items, got %d', total, numel(items));
end
items = struct('dims', uint32(count), 'array', {items(:)});
end
