function value = conformance_await(start)
%CONFORMANCE_AWAIT The value of a call that does not wait, once its handler was called.
ended = containers.Map();
start(@(parameter, value, err) finish(ended, value, err));
while ended.Count == 0
  RobotRaconteur.Poll(20);
end
outcome = ended('outcome');
value = outcome.value{1};
if ~isempty(outcome.error)
  error(outcome.error);
end
end

function finish(ended, value, err)
ended('outcome') = struct('value', {{value}}, 'error', err);
end
