function conformance_runner(verb, folder)
%CONFORMANCE_RUNNER Answer the requests of a verb until the input ends; the folder has the definitions.
if any(strcmp(verb, {'decode', 'encode', 'both'}))
  conformance_mex(verb, folder);
  return
end
conformance_mex('open', folder);
switch verb
  case 'call'
    player = ConformanceClient();
  case 'serve'
    player = ConformanceService();
  otherwise
    error('expected decode, encode, serve, call or both');
end
while true
  [request, state] = conformance_mex('read', player.Patience);
  if state < 0
    break
  elseif state == 0
    player.Work();
    continue
  end
  try
    answer = player.Answer(request);
  catch err
    answer = struct('error', err.message);
  end
  conformance_mex('write', answer);
end
RobotRaconteur.Shutdown();
end
