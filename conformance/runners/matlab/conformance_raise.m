function conformance_raise(what, parameters)
%CONFORMANCE_RAISE Throw what the `throw` of an outcome says; "$n" is parameter n of the call.
if isfield(what, 'native')
  error('%s', filled(what.native, parameters));
end
names = intersect(fieldnames(what), {'code', 'name', 'message', 'subname'});
given = struct();
for i = 1:numel(names)
  given.(names{i}) = filled(what.(names{i}), parameters);
end
if isfield(what, 'param')
  json = filled(what.param, parameters);
  given.parameter = conformance_mex('value', 'varvalue', json);
end
RobotRaconteur.ThrowError(given);
end

function value = filled(value, parameters)
if ischar(value) && numel(value) == 2 && value(1) == '$'
  value = parameters{1 + value(2) - '0'};
end
end
