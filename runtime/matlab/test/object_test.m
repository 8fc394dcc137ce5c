% Properties, functions, objects, events, callbacks, errors.

%!function c = bench()
%!  persistent kept
%!  if isempty(kept)
%!    kept = rr_bench();
%!  end
%!  c = kept;
%!endfunction

%!test % properties by assignment
%! c = bench();
%! c.v_int32 = 5;
%! assert(c.v_int32, int32(5));
%! c.v_int32 += 4;
%! assert(c.v_int32, int32(9));
%! c.set_v_int32(11);
%! assert(c.get_v_int32(), int32(11));
%! assert(c.fixed, int32(17));

%!test % parts of values
%! c = bench();
%! c.a_double = [1 2 3];
%! c.a_double(2) = 9;
%! assert(c.a_double, [1; 9; 3]);
%! c.a_double(end + 1) = 7;
%! assert(c.a_double(end), 7);
%! c.sample = struct('sequence', 1, 'stamp', 2, 'acceleration', [1 2 3]);
%! c.sample.sequence = 6;
%! assert(c.sample.acceleration(3), single(3));
%! assert(c.sample.sequence, uint32(6));

%!test % functions with and without parentheses
%! c = bench();
%! assert(c.add(40, 2), int32(42));
%! c.stop();
%! c.stop
%! f = @() c.add(1, 2);
%! assert(f(), int32(3));
%! name = 'add';
%! assert(c.(name)(1, 1), int32(2));

%!test % objects
%! c = bench();
%! t = c.get_tool();
%! assert(t.say('x'), 'the tool: x');
%! assert(c.get_tool.say('y'), 'the tool: y');
%! assert(c.get_tools(int32(3)).say('z'), 'tool 3: z');
%! assert(c.get_tools(4).say('z'), 'tool 4: z');
%! assert(c.get_named_tools('drill').say('z'), 'drill: z');
%! assert(type(c.get_any_tool()), 'experimental.bench.Tool');
%! t.force = 2.5;
%! assert(c.get_tool().force, 2.5);
%! assert(t == c.get_tool());
%! assert(t ~= c);
%! held = {t, struct('t', t)};
%! assert(held{2}.t.force, 2.5);

%!test % what an object tells of itself
%! c = bench();
%! assert(any(strcmp(methods(c), 'add')));
%! assert(any(strcmp(methods(c), 'get_tool')));
%! assert(ismethod(c, 'add') && ~ismethod(c, 'v_bool'));
%! assert(any(strcmp(properties(c), 'v_bool')) && isprop(c, 'v_bool'));
%! assert(any(strcmp(members(c), 'function int32 add(int32 a, int32 b)')));
%! text = evalc('disp(c)');
%! assert(~isempty(strfind(text, 'property int32 fixed [readonly] = 17')));
%! assert(~isempty(strfind(servicedef(c), 'service experimental.bench')));
%! assert(isvalid(c));

%!test % definitions
%! c = bench();
%! k = RobotRaconteur.GetConstants(c, 'experimental.bench');
%! assert(k.LIMIT, int32(42));
%! assert(k.WEIGHTS, [0.25; -0.5]);
%! assert(k.GREETING, 'hello');
%! assert(k.LIMITS.least, int32(42));
%! assert(k.Mode.running, int32(3));
%! assert(k.Tool.TEETH, int32(7));
%! assert(RobotRaconteur.GetPulledServiceTypes(c), {'experimental.bench'});
%! assert(~isempty(strfind(RobotRaconteur.GetPulledServiceType(c, 'experimental.bench'), 'TEETH')));
%! s = RobotRaconteur.CreateStructure(c, 'experimental.bench.Report');
%! assert(s.count, int32(0));
%! assert(s.text, '');
%! assert(size(s.numbers), [0 1]);
%! assert(isempty(s.next));
%! c.report = s;
%! p = RobotRaconteur.CreateStructure(c, 'experimental.bench.Pose');
%! assert(p, zeros(7, 1));
%! a = RobotRaconteur.GetServiceAttributes(c);
%! assert(a('place'), 'roof');

%!test % an exception of the service, with its data
%! c = bench();
%! try
%!   c.lose_tool('attic');
%!   error('not thrown');
%! catch err
%!   assert(err.identifier, 'experimental:bench:ToolLost');
%!   assert(err.message, 'the tool is lost (where)');
%! end
%! e = RobotRaconteur.GetLastError();
%! assert(e.subname, 'where');
%! assert(e.parameter('place'), 'attic');
%! assert(e.code, 100);

%!error <as asked for> bench().fail('some.other.Fault')
%!error id=some:other:Fault bench().fail('some.other.Fault')
%!error id=RobotRaconteur:ValueError bench().fail('ValueError')
%!error id=RobotRaconteur:MemberNotFound bench().not_there % by name
%!error id=RobotRaconteur:MemberNotFound bench().not_there() % by name
%!error <has no member `not_there`> bench().not_there % by name
%!error id=RobotRaconteur:InvalidArgument bench().add(1) % by name
%!error id=RobotRaconteur:InvalidArgument bench().add(1, 2, 3) % by name
%!error id=RobotRaconteur:WriteOnlyMember bench().password
%!error id=RobotRaconteur:OutOfRange bench().get_tools(-1)
%!error id=RobotRaconteur:InvalidArgument bench().get_tools('x')
%!error id=RobotRaconteur:DataTypeMismatch bench().add(1, 'x')
%!error <member add, parameter b: expected int32, got char> bench().add(1, 'x')
%!error id=RobotRaconteur:ConnectionError RobotRaconteur.Connect('rr+tcp://127.0.0.1:1/?service=x')
%!error id=RobotRaconteur:InvalidArgument RobotRaconteur.Connect('nonsense')
%!error id=RobotRaconteur:ServiceNotFound rr_bench('nothing')
%!error id=RobotRaconteur:InvalidOperation rrmex('access', uint64(12345), 'x')
%!error id=RobotRaconteur:InvalidArgument rrmex('no such command')
%!error id=RobotRaconteur:DataTypeMismatch rrmex()
%!error id=RobotRaconteur:DataTypeMismatch rrmex('access')
%!error id=RobotRaconteur:DataTypeMismatch rrmex(5)

%!test % a read-only property
%! c = bench();
%! try
%!   c.fixed = 3;
%!   error('not thrown');
%! catch err
%!   assert(err.identifier, 'RobotRaconteur:ReadOnlyMember');
%! end

%!test % events, without being asked for, at Poll
%! c = bench();
%! rr_log_call('clear');
%! l = addlistener(c, 'fired', @(number, text) rr_log_call(number, text));
%! r = addlistener(c, 'reported', @(report) rr_log_call(report.count));
%! c.fire(3);
%! assert(rr_eventually(@() numel(rr_log_call()) == 4));
%! calls = rr_log_call();
%! assert(calls{2}, {int32(2), 'number 2'});
%! assert(calls{4}, {int32(3)});
%! delete(l);
%! c.fire(1);
%! assert(rr_eventually(@() numel(rr_log_call()) == 5));
%! delete(r);

%!test % events can be stopped and go on
%! c = bench();
%! rr_log_call('clear');
%! l = addlistener(c, 'fired', @(number, text) rr_log_call(number));
%! RobotRaconteur.DisableEvents(c);
%! c.fire(2);
%! c.stop();
%! RobotRaconteur.EnableEvents(c);
%! c.fire(1);
%! assert(rr_eventually(@() numel(rr_log_call()) >= 1));
%! RobotRaconteur.ProcessRequests();
%! assert(rr_log_call(){end}, {int32(1)});
%! delete(l);

%!test % a handler that fails does not lose the others
%! c = bench();
%! rr_log_call('clear');
%! l = addlistener(c, 'fired', @(number, text) error('some:id', 'bad'));
%! r = addlistener(c, 'reported', @(report) rr_log_call(1));
%! lastwarn('');
%! warning('off', 'RobotRaconteur:HandlerFailed', 'local');
%! warning('on', 'RobotRaconteur:HandlerFailed');
%! c.fire(1);
%! evalc('rr_eventually(@() numel(rr_log_call()) == 1)');
%! assert(numel(rr_log_call()), 1);
%! [message, id] = lastwarn();
%! assert(id, 'RobotRaconteur:HandlerFailed');
%! assert(message, 'a handler has failed: bad');
%! delete(l);
%! delete(r);

%!test % a handler may make calls
%! c = bench();
%! rr_log_call('clear');
%! l = addlistener(c, 'fired', @(number, text) rr_log_call(c.add(number, 1)));
%! c.fire(1);
%! assert(rr_eventually(@() numel(rr_log_call()) == 1));
%! assert(rr_log_call(){1}, {int32(2)});
%! delete(l);

%!error id=RobotRaconteur:MemberNotFound addlistener(bench(), 'nothing', @disp)
%!error id=RobotRaconteur:MemberFormatMismatch addlistener(bench(), 'add', @disp)
%!error id=RobotRaconteur:DataTypeMismatch addlistener(bench(), 'fired', 5)

%!test % callbacks run inside the call that needs them
%! c = rr_bench();
%! assert(isempty(c.advise));
%! c.advise = @(question) question * 2;
%! assert(class(c.advise), 'function_handle');
%! assert(c.consult(21), 42);
%! t = c.get_tool();
%! t.ask = @(question) question + c.add(1, 2);
%! assert(t.question(1), 4);
%! c.advise = @(question) error('my:mistake', 'no idea');
%! try
%!   c.consult(1);
%!   error('not thrown');
%! catch err
%!   assert(err.identifier, 'my:mistake');
%!   assert(err.message, 'no idea');
%! end
%! c.advise = @(question) 'text';
%! try
%!   c.consult(1);
%!   error('not thrown');
%! catch err
%!   assert(err.identifier, 'RobotRaconteur:DataTypeMismatch');
%! end
%! c.advise = [];
%! try
%!   c.consult(1);
%!   error('not thrown');
%! catch err
%!   assert(strncmp(err.identifier, 'RobotRaconteur:', 15));
%! end

%!test % asynchronous calls end at Poll
%! c = bench();
%! rr_log_call('clear');
%! c.async_add(40, 2, @(varargin) rr_log_call(varargin{:}), 'mine');
%! c.async_lose_tool('x', @(varargin) rr_log_call(varargin{:}), 'other');
%! assert(rr_eventually(@() numel(rr_log_call()) == 2));
%! assert(rr_log_call(){1}, {'mine', int32(42), []});
%! err = rr_log_call(){2}{3};
%! assert(err.identifier, 'experimental:bench:ToolLost');
%! rr_log_call('clear');
%! c.v_double = 1.5;
%! c.async_get_v_double(@(varargin) rr_log_call(varargin{:}));
%! assert(rr_eventually(@() numel(rr_log_call()) == 1));
%! assert(rr_log_call(){1}{2}, 1.5);
%! rr_log_call('clear');
%! c.async_set_v_double(2.5, @(varargin) rr_log_call(varargin{:}));
%! assert(rr_eventually(@() numel(rr_log_call()) == 1));
%! assert(c.v_double, 2.5);
%! rr_log_call('clear');
%! c.async_get_tools(2, @(varargin) rr_log_call(varargin{:}));
%! assert(rr_eventually(@() numel(rr_log_call()) == 1));
%! assert(rr_log_call(){1}{2}.say('a'), 'tool 2: a');
%! rr_log_call('clear');
%! c.async_nap(5, @(varargin) rr_log_call(varargin{:}), [], 0.05);
%! assert(rr_eventually(@() numel(rr_log_call()) == 1));
%! assert(rr_log_call(){1}{3}.identifier, 'RobotRaconteur:RequestTimeout');

%!test % users and locks
%! map = containers.Map({'password'}, {RobotRaconteurVarValue('open sesame', 'string')});
%! a = rr_bench('guarded', 'alice', map);
%! b = rr_bench('guarded', 'bob', struct('password', 'me too'));
%! RobotRaconteur.RequestObjectLock(a, 'User');
%! try
%!   b.v_double = 1;
%!   error('not thrown');
%! catch err
%!   assert(err.identifier, 'RobotRaconteur:ObjectLockedError');
%! end
%! RobotRaconteur.ReleaseObjectLock(a);
%! b.v_double = 1;
%! RobotRaconteur.RequestObjectLock(a, 'Client');
%! RobotRaconteur.ReleaseObjectLock(a);

%!error id=RobotRaconteur:AuthenticationError rr_bench('guarded', 'alice', struct('password', 'no'))
%!error id=RobotRaconteur:InvalidArgument RobotRaconteur.RequestObjectLock(bench(), 'Everything')

%!test % monitors
%! a = rr_bench();
%! b = rr_bench();
%! RobotRaconteur.MonitorEnter(a, 1);
%! try
%!   RobotRaconteur.MonitorEnter(b, 0.1);
%!   error('not thrown');
%! catch err
%!   assert(err.identifier, 'RobotRaconteur:OperationTimeout');
%! end
%! RobotRaconteur.MonitorExit(a);
%! RobotRaconteur.MonitorEnter(b, 1);
%! RobotRaconteur.MonitorExit(b);

%!test % time-outs
%! c = rr_bench();
%! RobotRaconteur.setRequestTimeout(0.1);
%! unwind_protect
%!   try
%!     c.nap(1);
%!     error('not thrown');
%!   catch err
%!     assert(err.identifier, 'RobotRaconteur:RequestTimeout');
%!   end
%! unwind_protect_cleanup
%!   RobotRaconteur.setRequestTimeout(15);
%! end_unwind_protect

%!test % the session ends with its last object
%! held = rrmex('node').held;
%! c = rr_bench();
%! t = c.get_tool();
%! clear c
%! assert(t.say('still'), 'the tool: still');
%! clear t
%! assert(rrmex('node').held, held);

%!test % an ended session
%! c = rr_bench();
%! RobotRaconteur.DisconnectService(c);
%! try
%!   c.add(1, 2);
%!   error('not thrown');
%! catch err
%!   assert(err.identifier, 'RobotRaconteur:InvalidOperation');
%! end
%! assert(~isempty(strfind(evalc('disp(c)'), 'the connection has ended')));
%! delete(c);
%! assert(~isvalid(c));
%! try
%!   c.add(1, 2);
%!   error('not thrown');
%! catch err
%!   assert(err.identifier, 'RobotRaconteur:InvalidOperation');
%! end

%!test % a large array comes with one copy
%! c = bench();
%! a = c.image(10e6);
%! assert(class(a), 'uint8');
%! assert(size(a), [1e7 1]);
%! assert(a(257), uint8(0));
%! assert(a(256), uint8(255));

%!test % the rest
%! now = RobotRaconteur.nowUTC();
%! assert(abs(double(now.seconds) - time()) < 5);
%! RobotRaconteur.SetLogLevel('ERROR');
%! path = fullfile(getenv('RR_TEST_FOLDER'), 'rr.log');
%! RobotRaconteur.OpenLogFile(path);
%! RobotRaconteur.CloseLogFile();
%! assert(exist(path, 'file'), 2);
%! start = tic();
%! RobotRaconteur.Sleep(0.05);
%! assert(toc(start) >= 0.05);

%!error id=RobotRaconteur:InvalidArgument RobotRaconteur.SetLogLevel('LOUD')
