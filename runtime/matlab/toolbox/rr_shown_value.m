function text = rr_shown_value(obj, name, declaration)
%RR_SHOWN_VALUE ` = value` of a property or wire, where it is short and can be read.
text = '';
kind = strtok(declaration);
try
  if strcmp(kind, 'property')
    value = rrmex('access', obj, name);
  elseif strcmp(kind, 'wire')
    value = rrmex('wire_peek', obj, name, false);
  else
    return
  end
catch
  return
end
if isa(value, 'int32') && isscalar(value)
  shown = rrmex('shown_enum', obj, name, value);
  if ~isempty(shown)
    text = [' = ', shown];
    return
  end
end
if isa(value, 'RobotRaconteurMultiDimArray')
  value = to_array(value);
end
if ischar(value)
  text = [' = ''', value, ''''];
elseif (isnumeric(value) || islogical(value)) && numel(value) <= 16 && ndims(value) == 2
  text = [' = ', mat2str(value)];
else
  text = sprintf(' = %s %s', strrep(mat2str(size(value)), ' ', 'x'), class(value));
end
if numel(text) > 60
  text = [text(1:57), '...'];
end
end
