% Subscriptions, and services that go and come back.

%!function url = bench_url(port)
%!  if nargin < 1
%!    port = getenv('RR_TEST_PORT');
%!  end
%!  url = ['rr+tcp://127.0.0.1:', port, '/?service=bench'];
%!endfunction

%!function answer = try_level(c, w)
%!  c.show_level(0.75);
%!  answer = w.WaitInValueValid(0.1);
%!endfunction

%!function port = start_second(starter, folder, port)
%!  [~] = unlink(fullfile(folder, 'second'));
%!  system(['sh ', starter, ' ', port]);
%!  port = '';
%!  start = tic();
%!  while isempty(port) && toc(start) < 20
%!    pause(0.05);
%!    [is_there, ~, ~] = stat(fullfile(folder, 'second'));
%!    if ~isempty(is_there)
%!      port = strtrim(strrep(fileread(fullfile(folder, 'second')), 'ready:', ''));
%!    end
%!  end
%!endfunction

%!test % default client
%! sub = RobotRaconteur.SubscribeService(bench_url());
%! c = sub.GetDefaultClientWait(20);
%! assert(c.add(1, 2), int32(3));
%! assert(sub.GetDefaultClient() == c);
%! [has_one, d] = sub.TryGetDefaultClient();
%! assert(has_one && d == c);
%! found = sub.GetConnectedClients();
%! assert(numel(found), 1);
%! assert(found{1}.ServiceName, 'bench');
%! assert(found{1}.Client == c);
%! assert(isempty(sub.GetClientConnectFailures()));
%! sub.Close();
%! try
%!   c.add(1, 2);
%!   error('not thrown');
%! catch err
%!   assert(strncmp(err.identifier, 'RobotRaconteur:', 15));
%! end

%!test % members
%! sub = RobotRaconteur.SubscribeService(bench_url());
%! w = sub.SubscribeWire('level');
%! r = sub.SubscribeWire('reports');
%! p = sub.SubscribePipe('numbers');
%! o = sub.SubscribeSubObject('*.tool');
%! c = sub.GetDefaultClientWait(20);
%! assert(o.GetDefaultClientWait(20).say('x'), 'the tool: x');
%! assert(rr_eventually(@() try_level(c, w)));
%! assert(w.InValue, 0.75);
%! [is_valid, value, time, client] = w.TryGetInValue();
%! assert(client.ServiceName, 'bench');
%! assert(r.WaitInValueValid(20));
%! assert(r.InValue.numbers, 0.75);
%! all = w.GetAllInValues();
%! assert(all{1}.Value, 0.75);
%! assert(w.SetOutValueAll(int8(4)), 1);
%! assert(rr_eventually(@() c.level_out() == 4));
%! assert(rr_eventually(@() p.SendPacketAll(8) == 1));
%! assert(p.ReceivePacketWait(20), 16);
%! rr_log_call('clear');
%! l = addlistener(w, 'WireValueChanged', @(value, time, client) rr_log_call(value));
%! c.show_level(0.5);
%! assert(rr_eventually(@() numel(rr_log_call()) > 0 && rr_log_call(){end}{1} == 0.5));
%! assert(w.GetLastError(), '');
%! bad = sub.SubscribeWire('no_such_wire');
%! assert(rr_eventually(@() ~isempty(bad.GetLastError())));
%! sub.Close();

%!error id=RobotRaconteur:OperationTimeout RobotRaconteur.SubscribeService(bench_url('1')).GetDefaultClientWait(0.1)
%!error id=RobotRaconteur:InvalidArgument RobotRaconteur.SubscribeService('nonsense')

%!test % a service that is killed and comes back
%! folder = getenv('RR_TEST_FOLDER');
%! starter = fullfile(folder, 'second.sh');
%! f = fopen(starter, 'w');
%! fprintf(f, '"%s" --seconds 60 --port $1 > "%s/second" 2>&1 &\necho $! > "%s/pid"\n', ...
%!         getenv('RR_TEST_SERVICE'), folder, folder);
%! fclose(f);
%! port = start_second(starter, folder, '0');
%! sub = RobotRaconteur.SubscribeService(bench_url(port));
%! sub.SetConnectRetryDelay(0.1);
%! rr_log_call('clear');
%! l = addlistener(sub, 'ClientConnected', @(id) rr_log_call('came'));
%! m = addlistener(sub, 'ClientDisconnected', @(id, why) rr_log_call('went'));
%! n = addlistener(sub, 'ClientConnectFailed', @(url, why) rr_log_call('failed'));
%! c = sub.GetDefaultClientWait(20);
%! direct = RobotRaconteur.ConnectService(bench_url(port));
%! w = direct.level.Connect();
%! try
%!   direct.crash();
%!   error('not thrown');
%! catch err
%!   assert(err.identifier, 'RobotRaconteur:ConnectionError');
%! end
%! try
%!   c.add(1, 2);
%!   error('not thrown');
%! catch err
%!   assert(strncmp(err.identifier, 'RobotRaconteur:', 15));
%! end
%! assert(rr_eventually(@() any(cellfun(@(x) strcmp(x{1}, 'failed'), rr_log_call()))));
%! assert(rr_eventually(@() ~w.IsOpen));
%! assert(~isempty(sub.GetClientConnectFailures()));
%! start_second(starter, folder, port);
%! assert(rr_eventually(@() sub.TryGetDefaultClient()));
%! assert(sub.GetDefaultClientWait(20).add(2, 3), int32(5));
%! names = cellfun(@(x) x{1}, rr_log_call(), 'UniformOutput', false);
%! assert(names(1), {'came'});
%! assert(any(strcmp(names, 'went')));
%! sub.Close();
%! system(['kill $(cat ', folder, '/pid)']);

%!test % claims
%! sub = RobotRaconteur.SubscribeService(bench_url());
%! c = sub.GetDefaultClientWait(20);
%! claim = sub.ClaimClient(c);
%! sub.Close();
%! d = c;
%! assert(c.add(1, 1), int32(2));
%! rrmex('close', claim);

%!test % discovery answers, be there somebody or not
%! found = RobotRaconteur.FindServiceByType('experimental.bench.Nothing', {'rr+tcp'}, 0.1);
%! assert(isempty(found));
%! assert(fieldnames(found){1}, 'Name');
%! nodes = RobotRaconteur.GetDetectedNodes();
%! assert(isstruct(nodes));
%! info = RobotRaconteur.SubscribeServiceInfo2({'experimental.bench.Bench'});
%! assert(isstruct(info.GetDetectedServiceInfo2()));
%! info.Close();
%! sub = RobotRaconteur.SubscribeServiceByType('experimental.bench.Nothing', ...
%!   struct('ServiceNames', {{'bench'}}, 'MaxConnections', 2));
%! assert(~sub.TryGetDefaultClient());
%! sub.Close();
