function values = conformance_values(types, list)
%CONFORMANCE_VALUES The values of parameters, for the toolbox, from their notation.
if numel(list) ~= numel(types)
  error('expected %d parameters, got %d', numel(types), numel(list));
end
values = cell(1, numel(list));
for i = 1:numel(list)
  values{i} = conformance_mex('value', types{i}, list{i});
end
end
