function answer = rr_isequal(a, b)
%RR_ISEQUAL Whether two values of services are the same: class, sizes, contents; NaN equals itself.
answer = strcmp(class(a), class(b));
if ~answer
  return
end
if isa(a, 'RobotRaconteurVarValue')
  answer = strcmp(a.datatype, b.datatype) && rr_isequal(a.data, b.data);
elseif isa(a, 'containers.Map')
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
  answer = iscomplex_or_real(a, b) && all((a(:) == b(:)) | (isnan(a(:)) & isnan(b(:))));
else
  answer = isequal(a, b);
end
end

function answer = iscomplex_or_real(a, b)
answer = isreal(a) == isreal(b);
end
