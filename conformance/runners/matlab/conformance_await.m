function value = conformance_await(start)
%CONFORMANCE_AWAIT The value of a call that does not wait, once its handler was called.
ended = containers.Map();
start(@(parameter, value, err) finish(ended, value, err));
while ended.Count == 0
  RobotRaconteur.Poll(20);
end
value = ended('value');
end

function finish(ended, value, err)
ended('error') = err;
ended('value') = value;
end
