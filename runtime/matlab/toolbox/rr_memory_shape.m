function items = rr_memory_shape(items, count)
%RR_MEMORY_SHAPE Items for a box of a memory: one for all, or as many as it has.
total = prod(count);
if numel(items) == 1 && total ~= 1 && ~isstruct(items)
  items = repmat(items, [count, 1]);
end
if numel(count) < 2
  return
end
if numel(items) == total
  items = struct('dims', uint32(count), 'array', {reshape(items, [], 1)});
elseif mod(numel(items), max(total, 1)) == 0 && total ~= 0
  items = reshape(items, [numel(items) / total, count]);
else
  error('RobotRaconteur:InvalidArgument', 'expected %d items, got %d', total, numel(items));
end
end
