function raised = conformance_raised(err)
%CONFORMANCE_RAISED An error of the toolbox as the suite wants to be told of it.
last = RobotRaconteur.GetLastError();
if isempty(last) || ~strcmp(last.identifier, err.identifier)
  rethrow(err);
end
raised = struct('code', last.code, 'name', last.name, 'message', last.message);
if ~isempty(last.subname)
  raised.subname = last.subname;
end
if ~isempty(last.varvalue)
  raised.param = conformance_mex('json', 'varvalue', last.varvalue);
end
end
