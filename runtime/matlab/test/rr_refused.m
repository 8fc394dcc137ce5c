function rr_refused(c, name, given, text)
%RR_REFUSED A property cannot be set to `given`, and the error says so in these words.
try
  c.(name) = given;
catch err
  assert(err.identifier, 'RobotRaconteur:DataTypeMismatch');
  assert(strcmp(err.message, text), 'says %s', err.message);
  return
end
error('taken');
end
