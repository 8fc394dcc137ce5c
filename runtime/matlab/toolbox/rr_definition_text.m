function text = rr_definition_text(definition)
%RR_DEFINITION_TEXT The text of a definition that is given as such, or by the name of its file.
if ~ischar(definition) && ~isa(definition, 'string')
  error('RobotRaconteur:DataTypeMismatch', ...
        'expected the text of a definition or the name of a file, got %s', class(definition));
end
text = char(definition);
if any(text == char(10)) || ~isempty(regexp(text, '^\s*(service\s|#)', 'once'))
  return
end
if exist(text, 'file') ~= 2
  error('RobotRaconteur:ResourceNotFound', ...
        'there is no file `%s`, and it is not the text of a definition, which begins with `service`', ...
        text(1:min(end, 100)));
end
text = fileread(text);
end
