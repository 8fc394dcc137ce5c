function answer = rr_isequal(a, b)
%RR_ISEQUAL Whether two values of services are the same: class, sizes, contents; NaN equals itself.
answer = strcmp(class(a), class(b));
if ~answer
  return
end
if isa(a, 'RobotRaconteurVarValue')
  answer = strcmp(a.datatype, b.datatype) && rr_isequal(a.data, b.data);
elseif isa(a, 'RobotRaconteurMultiDimArray')
  answer = isequal(a.dims, b.dims) && rr_isequal(a.array, b.array);
elseif isa(a, 'containers.Map') || isa(a, 'RobotRaconteurMap')
  answer = strcmp(a.KeyType, b.KeyType) && rr_isequal(a.keys(), b.keys()) && ...
           rr_isequal(a.values(), b.values());
elseif ~isequal(size(a), size(b))
  answer = false;
elseif iscell(a)
  answer = all(cellfun(@rr_isequal, a(:), b(:)));
elseif isstruct(a)
  answer = isequal(fieldnames(a), fieldnames(b)) && ...
           rr_isequal(struct2cell(a(:)), struct2cell(b(:)));
elseif isfloat(a)
  answer = isreal(a) == isreal(b) && has_same(real(a), real(b)) && ...
           (isreal(a) || has_same(imag(a), imag(b)));
else
  answer = isequal(a, b);
end
end

function answer = has_same(a, b)
answer = all((a(:) == b(:)) | (isnan(a(:)) & isnan(b(:))));
end
