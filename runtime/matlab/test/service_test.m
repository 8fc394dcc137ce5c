% Services that Octave offers, used by a client in the same interpreter and by one in C++.

%!function [service, rig, url] = offered()
%!  persistent kept
%!  if isempty(kept)
%!    RobotRaconteur.RegisterServiceType(fullfile(getenv('RR_TEST_FILES'), 'experimental.rig.robdef'));
%!    kept.rig = rr_rig();
%!    kept.service = RobotRaconteur.RegisterService('rig', 'experimental.rig.Rig', kept.rig, ...
%!      struct('Attributes', struct('place', 'roof')));
%!    kept.rig.served = kept.service.Root;
%!    port = RobotRaconteur.StartServer(0, '127.0.0.1');
%!    kept.url = sprintf('rr+tcp://127.0.0.1:%d/?service=', port);
%!  end
%!  service = kept.service;
%!  rig = kept.rig;
%!  url = kept.url;
%!endfunction

%!function c = client()
%!  persistent kept
%!  if isempty(kept)
%!    [~, ~, url] = offered();
%!    kept = RobotRaconteur.ConnectService([url, 'rig']);
%!  end
%!  c = kept;
%!endfunction

%!function fails(f, identifier, text)
%!  try
%!    f();
%!  catch err
%!    assert(err.identifier, identifier);
%!    assert(strcmp(err.message, text), 'says %s', err.message);
%!    return
%!  end
%!  error('it has not failed');
%!endfunction

%!function assign(object)
%!  object.number = 1;
%!endfunction

%!function put(map, key, value)
%!  map(double(key)) = value;
%!endfunction

%!function set_speed(state, value)
%!  state('speed') = value;
%!endfunction

%!function text = failure_of(c)
%!  text = '';
%!  try
%!    c.add(1, 2);
%!  catch err
%!    text = err.message;
%!  end
%!endfunction

%!test % properties of a handle object
%! [~, rig] = offered();
%! c = client();
%! assert(c.speed, 1);
%! c.speed = 2.5;
%! assert(rig.speed, 2.5);
%! assert(c.count, int16(2));
%! rig.count = 40000;
%! fails(@() c.count, 'RobotRaconteur:DataTypeMismatch', 'member count: int16 cannot hold 40000');
%! rig.count = 3;
%! assert(c.note, []);
%! c.note = struct('text', 'a', 'numbers', [1; 2]);
%! assert(rig.note, struct('text', 'a', 'numbers', [1; 2]));
%! assert(c.mode, int32(5));
%! assert(c.title, 'the rig');

%!test % functions, errors and exceptions of the definition
%! [~, rig] = offered();
%! c = client();
%! assert(c.add(1, 2), 3);
%! c.stop();
%! assert(rig.stopped, 1);
%! fails(@() c.jam('stuck'), 'experimental:rig:Jam', 'stuck');
%! value = c.echo(RobotRaconteurVarValue(struct('id', int16(1), 'at', [1; 2; 3]), ...
%!   'experimental.rig.Sample[]'));
%! assert(value.datatype, 'experimental.rig.Sample[]');
%! assert(value.data.at, [1; 2; 3]);

%!test % generators
%! c = client();
%! g = c.count_to(3);
%! assert(g.Next(), 0);
%! assert(g.Next(), 1);
%! assert(g.Next(), 2);
%! fails(@() g.Next(), 'RobotRaconteur:StopIteration', 'the generator has ended');
%! g = c.sum(10);
%! assert(g.Next(1), 11);
%! assert(g.Next(5), 16);
%! g.Close();
%! g = c.sum(99);
%! fails(@() g.Next(2), 'RobotRaconteur:StopIteration', 'the generator has ended');

%!test % objects: handle objects, structs, none, and what has a type of its own
%! c = client();
%! assert(c.get_child().number, int32(1));
%! child = c.get_children(7);
%! assert(child.name(), 'child 7');
%! child.number = 8;
%! assert(c.get_children(7).name(), 'child 8');
%! named = c.get_by_name('arm');
%! assert(named.number, int32(3));
%! assert(named.name(), 'named arm');
%! fails(@() assign(named), 'RobotRaconteur:NotImplementedError', 'number cannot be set');
%! assert(c.get_anything().number, int32(99));
%! try
%!   c.get_children(-1);
%!   error('there is a child');
%! catch err
%!   assert(err.identifier, 'RobotRaconteur:ServiceError');
%! end

%!test % events and callbacks
%! c = client();
%! came = containers.Map('KeyType', 'double', 'ValueType', 'any');
%! l = addlistener(c, 'changed', @(number, at) put(came, number, at));
%! c.fire(2);
%! assert(rr_eventually(@() came.Count == 2));
%! assert(came(2), [2; 2; 3]);
%! delete(l);
%! c.ask = @(question) [question, '!'];
%! assert(c.ask_back('who'), 'who!');

%!test % wires and pipes
%! [service, rig] = offered();
%! c = client();
%! service.Root.SetInValue('force', [1; 2; 3]);
%! w = c.force.Connect();
%! assert(rr_eventually(@() w.InValueValid));
%! assert(w.InValue, [1; 2; 3]);
%! w.OutValue = [4; 5; 6];
%! assert(rr_eventually(@() ~isempty(rig.forces)));
%! assert(rig.forces(:, end), [4; 5; 6]);
%! assert(service.Root.OutValue('force'), [4; 5; 6]);
%! w.Close();
%! p = c.samples.Connect(-1);
%! p.SendPacket(struct('id', 7, 'at', [1; 2; 3]));
%! assert(rr_eventually(@() p.Available > 0));
%! assert(p.ReceivePacket().id, int16(7));
%! assert(rig.packets(1).at, [1; 2; 3]);
%! p.Close();

%!test % memories
%! service = offered();
%! c = client();
%! m = c.buffer;
%! assert(m(:), [0; 1; 2; 3]);
%! m(2:3) = [10; 20];
%! assert(service.Root.Memory('buffer'), [0; 10; 20; 3]);
%! service.Root.SetMemory('buffer', (1:5)');
%! m = c.buffer;
%! assert(m(4:5), [4; 5]);
%! g = c.grid;
%! assert(g(:, 2:3), int16([2 3; 5 6]));
%! whole = RobotRaconteurMultiDimArray([2 2 1], int16(1:4));
%! service.Root.SetMemory('grid', whole);
%! assert(rr_isequal(service.Root.Memory('grid'), whole));
%! assert(size(g), [2 2 1]);
%! g(2, :, 1) = [20 40];
%! assert(service.Root.Memory('grid').array, int16([1; 20; 3; 40]));
%! service.Root.SetMemory('grid', [1 2 3; 4 5 6]);

%!test % a struct of function handles
%! [~, ~, url] = offered();
%! state = containers.Map({'speed'}, {4});
%! served = struct('speed', @() state('speed'), 'set_speed', @(value) set_speed(state, value), ...
%!                 'add', @(a, b) a * b, 'title', 'constant', ...
%!                 'count_to', @(limit) struct('next', @(value) error('RobotRaconteur:StopIteration', '')));
%! service = RobotRaconteur.RegisterService('other', 'experimental.rig.Rig', served);
%! c = RobotRaconteur.ConnectService([url, 'other']);
%! assert(c.speed, 4);
%! c.speed = 5;
%! assert(state('speed'), 5);
%! assert(c.add(3, 4), 12);
%! assert(c.title, 'constant');
%! fails(@() c.stop(), 'RobotRaconteur:NotImplementedError', 'stop is not implemented by this object');
%! service.Close();
%! assert(rr_eventually(@() ~isempty(failure_of(c))));

%!test % a client in C++, while the interpreter serves
%! [service, ~, url] = offered();
%! report = fullfile(getenv('RR_TEST_FOLDER'), 'client');
%! system(sprintf('"%s" "%srig" > "%s" 2>&1; echo end >> "%s"', getenv('RR_TEST_CLIENT'), url, ...
%!   report, report), false, 'async');
%! count = 0;
%! for i = 1:300
%!   count = count + RobotRaconteur.ServeFor(0.1);
%!   if ~exist(report, 'file')
%!     continue
%!   end
%!   text = fileread(report);
%!   if strfind(text, 'end')
%!     break
%!   end
%! end
%! assert(text, sprintf('as expected\nend\n'));
%! assert(count > 20);

%!test % errors with what an identifier cannot say, and errors that are passed on
%! [~, ~, url] = offered();
%! served.add = @(a, b) RobotRaconteur.ThrowError(struct('name', 'experimental.rig.Jam', ...
%!   'message', 'stuck', 'subname', 'joint', 'parameter', ...
%!   RobotRaconteurVarValue(int16([a; b]), 'int16[]')));
%! served.stop = @() RobotRaconteur.ThrowError(struct('code', 999, 'name', 'some.Name'));
%! other = client();
%! served.jam = @(text) other.jam(text);
%! served.title = @() RobotRaconteur.ThrowError(struct('name', 'RobotRaconteur.OutOfRange', ...
%!                                                     'message', '100% over'));
%! service = RobotRaconteur.RegisterService('errors', 'experimental.rig.Rig', served);
%! c = RobotRaconteur.ConnectService([url, 'errors']);
%! fails(@() c.add(1, 2), 'experimental:rig:Jam', 'stuck (joint)');
%! last = RobotRaconteur.GetLastError();
%! assert(last.code, 100);
%! assert(last.name, 'experimental.rig.Jam');
%! assert(last.message, 'stuck');
%! assert(last.subname, 'joint');
%! assert(last.parameter, int16([1; 2]));
%! assert(isequal(last.varvalue, RobotRaconteurVarValue(int16([1; 2]), 'int16[]')));
%! fails(@() c.stop(), 'some:Name', 'some.Name');
%! assert(RobotRaconteur.GetLastError().code, 999);
%! fails(@() c.jam('far away'), 'experimental:rig:Jam', 'far away');
%! fails(@() c.title, 'RobotRaconteur:OutOfRange', '100% over');
%! assert(RobotRaconteur.GetLastError().code, 29);
%! fails(@() RobotRaconteur.ThrowError(5), 'RobotRaconteur:DataTypeMismatch', ...
%!   'expected a struct, got double');
%! service.Close();

%!test % what happens to a session, and types of objects
%! [~, ~, url] = offered();
%! service = RobotRaconteur.RegisterService('short', 'experimental.rig.Rig', rr_rig());
%! c = RobotRaconteur.ConnectService([url, 'short']);
%! rr_log_call('clear');
%! l = RobotRaconteur.AddClientServiceListener(c, @(what, detail) rr_log_call(what, detail));
%! assert(RobotRaconteur.FindObjectType(c, 'child'), 'experimental.rig.Child');
%! assert(RobotRaconteur.FindObjectType(c, 'children', 3), 'experimental.rig.Child');
%! assert(RobotRaconteur.FindObjectType(c, 'by_name', 'left arm'), 'experimental.rig.Child');
%! c.get_children(7);
%! service.ReleasePath('short.children[7]');
%! assert(rr_eventually(@() numel(rr_log_call()) == 1));
%! assert(rr_log_call(){1}, {'ServicePathReleased', 'short.children[7]'});
%! service.Close();
%! assert(rr_eventually(@() numel(rr_log_call()) == 2));
%! assert(rr_log_call(){2}{1}, 'ClientClosed');
%! fails(@() RobotRaconteur.AddClientServiceListener(c, @(what, detail) 0), ...
%!   'RobotRaconteur:InvalidOperation', 'the session has ended');
%! other = client();
%! l = RobotRaconteur.AddClientServiceListener(other, @(what, detail) rr_log_call('deleted'));
%! delete(l);

%!test % a client that ends the session hears of it, too
%! [~, ~, url] = offered();
%! c = RobotRaconteur.ConnectService([url, 'rig']);
%! rr_log_call('clear');
%! RobotRaconteur.AddClientServiceListener(c, @(what, detail) rr_log_call(what));
%! RobotRaconteur.DisconnectService(c);
%! assert(rr_eventually(@() numel(rr_log_call()) == 1));
%! assert(rr_log_call(), {{'ClientClosed'}});

%!test % what is peeked, who has connected, and ending connections
%! [~, ~, url] = offered();
%! rr_log_call('clear');
%! served.peek_in_force = @() [7; 8; 9];
%! served.peek_out_force = @() error('RobotRaconteur:ValueNotSet', 'nothing yet');
%! served.connected_force = @(number) rr_log_call('wire', number);
%! served.connected_samples = @(number) rr_log_call('pipe', number);
%! service = RobotRaconteur.RegisterService('streams', 'experimental.rig.Rig', served);
%! c = RobotRaconteur.ConnectService([url, 'streams']);
%! assert(c.force.PeekInValue(), [7; 8; 9]);
%! fails(@() c.force.PeekOutValue(), 'RobotRaconteur:ValueNotSet', 'nothing yet');
%! w = c.force.Connect();
%! first = c.samples.Connect();
%! second = c.samples.Connect();
%! assert(rr_eventually(@() numel(rr_log_call()) == 3));
%! calls = rr_log_call();
%! assert({calls{1}{1}, calls{2}{1}, calls{3}{1}}, {'wire', 'pipe', 'pipe'});
%! assert(calls{1}{2}, service.Clients());
%! ends = service.Root.Endpoints('samples');
%! assert(size(ends), [2 1]);
%! to_second = ends([ends.index] == second.Index);
%! service.Root.SendPacketTo('samples', to_second, struct('id', 5, 'at', [0; 0; 0]), true);
%! service.Root.SendPacket('samples', struct('id', 6, 'at', [0; 0; 0]), true);
%! service.Root.SendPacket('samples', struct('id', 7, 'at', [0; 0; 0]));
%! assert(second.ReceivePacketWait(20).id, int16(5));
%! assert(second.ReceivePacketWait(20).id, int16(6));
%! assert(first.ReceivePacketWait(20).id, int16(6));
%! rr_log_call('clear');
%! addlistener(w, 'WireConnectionClosed', @() rr_log_call('wire'));
%! addlistener(first, 'PipeEndpointClosed', @() rr_log_call('pipe'));
%! service.Root.Disconnect('force');
%! service.Root.Disconnect('samples');
%! assert(rr_eventually(@() numel(rr_log_call()) == 2));
%! assert(rr_eventually(@() ~w.IsOpen && ~first.IsOpen && ~second.IsOpen));
%! fails(@() service.Root.SendPacketTo('samples', to_second, struct('id', 5, 'at', [0; 0; 0])), ...
%!   'RobotRaconteur:InvalidOperation', 'member samples: the endpoint is closed');
%! service.Close();

%!test % packets are told to the object before a request that was sent after them
%! [~, rig] = offered();
%! c = client();
%! p = c.samples.Connect();
%! rig.packets = [];
%! for i = 1:5
%!   p.SendPacket(struct('id', i, 'at', [0; 0; 0]));
%! end
%! c.add(1, 2);
%! assert(numel(rig.packets), 5);
%! p.Close();

%!test % monitors, users who need not be, attributes with their types, definitions that are offered
%! [~, ~, url] = offered();
%! RobotRaconteur.RegisterServiceType(sprintf('service experimental.other\nstdver 0.10\nobject Thing\nend\n'));
%! root = RobotRaconteurServed('experimental.rig.Rig', struct('add', @(a, b) a + b));
%! root.EnableMonitor();
%! options = struct('Users', 'ann 5f4dcc3b5aa765d61d8327deb882cf99 objectlock', 'RequireUser', false);
%! options.Attributes = struct('gain', RobotRaconteurVarValue(0.5, 'double[]'), 'place', 'roof');
%! options.ExtraImports = {};
%! service = RobotRaconteur.RegisterService('monitored', 'experimental.rig.Rig', root, options);
%! a = RobotRaconteur.ConnectService([url, 'monitored']);
%! b = RobotRaconteur.ConnectService([url, 'monitored']);
%! [values, varvalues] = RobotRaconteur.GetServiceAttributes(a);
%! assert(values('gain'), 0.5);
%! assert(varvalues('gain').datatype, 'double[]');
%! assert(varvalues('place').data, 'roof');
%! assert(RobotRaconteur.GetPulledServiceTypes(a), {'experimental.rig'});
%! RobotRaconteur.MonitorEnter(a, 5);
%! fails(@() RobotRaconteur.MonitorEnter(b, 0.1), 'RobotRaconteur:OperationTimeout', ...
%!   'the monitor is in use');
%! RobotRaconteur.MonitorExit(a);
%! RobotRaconteur.MonitorEnter(b, 5);
%! RobotRaconteur.MonitorExit(b);
%! service.Close();

%!test % rights: by rules, and by others while a client is connected
%! [~, ~, url] = offered();
%! options = struct('Rights', sprintf('deny anyone path sealed member add\nallow anyone\n'));
%! service = RobotRaconteur.RegisterService('sealed', 'experimental.rig.Rig', rr_rig(), options);
%! c = RobotRaconteur.ConnectService([url, 'sealed']);
%! fails(@() c.add(1, 2), 'RobotRaconteur:AuthenticationError', ...
%!   'A client that is not logged in may not call `add` of `sealed`');
%! service.SetRights([]);
%! assert(c.add(1, 2), 3);
%! service.SetRights('');
%! assert(~isempty(strfind(failure_of(c), 'may not call')));
%! fails(@() service.SetRights('permit bob'), 'RobotRaconteur:InvalidConfiguration', ...
%!   'rights:1:1: a rule begins with `allow` or `deny`');
%! service.Close();
%! fails(@() RobotRaconteur.RegisterService('x', 'experimental.rig.Rig', rr_rig(), struct('Right', '')), ...
%!   'RobotRaconteur:InvalidArgument', 'service options: there is no `Right`');

%!test % definitions with mistakes
%! fails(@() RobotRaconteurServed('experimental.rig.Rug', struct()), 'RobotRaconteur:KeyNotFound', ...
%!   'no object `experimental.rig.Rug`');

%!test % the interpreter ends while a service is offered, and clients are connected
%! RobotRaconteur.Shutdown();

%!test % options of the node, which come before it
%! fails(@() RobotRaconteur.SetNodeOptions(struct('Nodename', 'x')), ...
%!   'RobotRaconteur:InvalidArgument', 'node options: there is no `Nodename`');
%! fails(@() RobotRaconteur.SetNodeOptions(struct('ClientOffer', 5)), ...
%!   'RobotRaconteur:DataTypeMismatch', 'what the node offers: expected a struct, got double');
%! fails(@() RobotRaconteur.SetNodeOptions(struct('AuditFile', '/no/such/folder/audit')), ...
%!   'RobotRaconteur:InvalidConfiguration', ...
%!   'cannot open `/no/such/folder/audit`: No such file or directory');
%! id = '{a1b2c3d4-1111-4222-8333-444455556666}';
%! audit = fullfile(getenv('RR_TEST_FOLDER'), 'audit.jsonl');
%! RobotRaconteur.SetNodeOptions(struct('NodeName', 'example.rig', 'NodeID', id, ...
%!   'HeartbeatPeriod', 2, 'ClientOffer', struct('MessageV4', false), ...
%!   'AuditFile', audit, 'AuditRequests', true));
%! RobotRaconteur.RegisterServiceType(fullfile(getenv('RR_TEST_FILES'), 'experimental.rig.robdef'));
%! assert(rrmex('node').id, id(2:end - 1));
%! fails(@() RobotRaconteur.SetNodeOptions(struct()), 'RobotRaconteur:InvalidOperation', ...
%!   'there is a node already; RobotRaconteur.Shutdown() ends it');
%! folder = fullfile(getenv('RR_TEST_FOLDER'), 'socket');
%! service = RobotRaconteur.RegisterService('rig', 'experimental.rig.Rig', rr_rig());
%! RobotRaconteur.Listen(['rr+local://', folder]);
%! port = RobotRaconteur.StartServer(0, '127.0.0.1');
%! c = RobotRaconteur.ConnectService(sprintf('rr+tcp://127.0.0.1:%d/?service=rig', port));
%! assert(rrmex('service', c.rr_h).node_name, 'example.rig');
%! assert(c.add(1, 2), 3);
%! RobotRaconteur.Shutdown();
%! lines = strsplit(strtrim(fileread(audit)), "\n");
%! assert(~isempty(strfind(lines{1}, '"event":"connect","outcome":"allowed","service":"rig"')));
%! assert(any(cellfun(@(line) ~isempty(strfind(line, '"member":"add","operation":"call"')), lines)));
%! RobotRaconteur.SetNodeOptions(struct('SharedMemory', true, 'Spin', 50e-6));
%! RobotRaconteur.RegisterServiceType(fullfile(getenv('RR_TEST_FILES'), 'experimental.rig.robdef'));
%! service = RobotRaconteur.RegisterService('rig', 'experimental.rig.Rig', rr_rig());
%! RobotRaconteur.Listen(['rr+local://', folder]);
%! c = RobotRaconteur.ConnectService(['rr+local://', folder, '?service=rig']);
%! assert(c.add(1, 2), 3);
%! assert(numel(strfind(fileread('/proc/self/maps'), '/memfd:robdef')), 2);
%! RobotRaconteur.Shutdown();
%! fails(@() RobotRaconteur.SetNodeOptions(struct('Spin', -1)), 'RobotRaconteur:DataTypeMismatch', ...
%!   'node options, Spin: expected seconds from 0 to 1');
%! RobotRaconteur.SetNodeOptions(struct('CertificateFile', '/no/such/certificate.pem'));
%! fails(@() rrmex('node'), 'RobotRaconteur:InvalidConfiguration', ...
%!   '`/no/such/certificate.pem`: it cannot be read');
%! RobotRaconteur.SetNodeOptions(struct('RequireTls', true));
%! fails(@() RobotRaconteur.ConnectService('rr+tcp://127.0.0.1:1/?service=rig'), 'RobotRaconteur:ConnectionError', ...
%!   'this node requires TLS, and `rr+tcp` does not use it: `rrs+tcp` does');
%! RobotRaconteur.Shutdown();
%! RobotRaconteur.SetNodeOptions(struct());
