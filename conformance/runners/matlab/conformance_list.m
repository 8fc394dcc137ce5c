function list = conformance_list(types, values)
%CONFORMANCE_LIST The notation of parameters.
list = cell(numel(values), 1);
for i = 1:numel(values)
  list{i} = conformance_mex('json', types{i}, values{i});
end
end
