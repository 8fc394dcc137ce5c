function sizes = rr_sizes(dims, count, dimension)
%RR_SIZES What size gives, as a cell for each result, for something of these sizes.
dims(end + 1:2) = 1;
if nargin == 3
  dims(end + 1:max(dimension)) = 1;
  dims = dims(dimension);
elseif count > 1
  dims(end + 1:count) = 1;
  dims = [dims(1:count - 1), prod(dims(count:end))];
end
sizes = {dims};
if count > 1
  sizes = num2cell(dims);
end
end
