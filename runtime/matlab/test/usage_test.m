% What MATLAB does with the toolbox as its documentation has it, and what users type at first: counts of
% results, error identifiers, logging in, enums, wires that are not connected, definitions that are no
% files, generators without end.

%!function c = bench()
%!  persistent kept
%!  if isempty(kept)
%!    kept = rr_bench();
%!  end
%!  c = kept;
%!endfunction

%!function fails(f, identifier, text)
%!  try
%!    f();
%!  catch err
%!    assert(err.identifier, identifier);
%!    assert(isempty(text) || ~isempty(strfind(err.message, text)), 'says %s', err.message);
%!    return
%!  end
%!  error('it has not failed');
%!endfunction

%!function s = behind(varargin)
%! % behind('.', 'stop', '()', {}): what MATLAB gives to subsref.
%!  s = struct('type', varargin(1:2:end), 'subs', varargin(2:2:end));
%!endfunction

%!function results = as_statement(object, s)
%! % As MATLAB runs a statement with an object whose class has its own subsref.
%!  results = cell(1, numArgumentsFromSubscript(object, s, 'Statement'));
%!  [results{:}] = subsref(object, s);
%!endfunction

%!test % every field of an identifier begins with a letter, and has letters, digits and underscores
%! c = bench();
%! names = {'some.other.Fault', 'some:other:Fault'; 'ValueError', 'RobotRaconteur:ValueError'; ...
%!          '3d.2nd-Fault', 'x3d:x2nd_Fault'; 'a..b', 'a:x:b'; 'RobotRaconteur.Fault', 'RobotRaconteur:Fault'; ...
%!          '_a.b c', 'x_a:b_c'; '.', 'x:x'};
%! for k = 1:rows(names)
%!   try
%!     c.fail(names{k, 1});
%!     error('not thrown');
%!   catch err
%!     assert(err.identifier, names{k, 2});
%!     assert(isempty(regexp(err.identifier, '^[A-Za-z]\w*(:[A-Za-z]\w*)+$', 'once')), false);
%!     assert(RobotRaconteur.ErrorName(err), names{k, 1});
%!   end
%! end

%!test % the full name of an error, also of one that was caught before others
%! c = bench();
%! try
%!   c.lose_tool('attic');
%! catch first
%! end
%! try
%!   c.fail('3d.Fault');
%! catch second
%! end
%! assert(first.identifier, 'experimental:bench:ToolLost');
%! assert(RobotRaconteur.ErrorName(first), 'experimental.bench.ToolLost');
%! assert(RobotRaconteur.ErrorName(second), '3d.Fault');
%! rr_log_call('clear');
%! c.async_fail('3d.Fault', @(varargin) rr_log_call(varargin{:}));
%! assert(rr_eventually(@() numel(rr_log_call()) == 1));
%! err = rr_log_call(){1}{3};
%! assert(err.identifier, 'x3d:Fault');
%! assert(err.name, '3d.Fault');
%! assert(RobotRaconteur.ErrorName(err), '3d.Fault');
%! try
%!   undefined_function_of_nobody();
%! catch other
%! end
%! assert(RobotRaconteur.ErrorName(other), '');

%!test % an identifier that a function of the user throws is the error's name on the other side
%! c = rr_bench();
%! c.advise = @(question) error('experimental:bench:ToolLost', 'it is lost');
%! fails(@() c.consult(1), 'experimental:bench:ToolLost', 'it is lost');
%! assert(RobotRaconteur.GetLastError().name, 'experimental.bench.ToolLost');
%! c.advise = @(question) error('Octave:some-id', 'own');
%! fails(@() c.consult(1), 'RobotRaconteur:RemoteError', 'own');
%! assert(RobotRaconteur.GetLastError().subname, 'Octave:some-id');
%! c.advise = [];

%!test % members without a result, as statements of MATLAB
%! c = bench(); % by name
%! assert(as_statement(c, behind('.', 'stop')), cell(1, 0)); % by name
%! assert(as_statement(c, behind('.', 'stop', '()', {})), cell(1, 0)); % by name
%! assert(as_statement(c, behind('.', 'set_v_double', '()', {4.5})), cell(1, 0)); % by name
%! assert(as_statement(c, behind('.', 'v_double')), {4.5}); % by name
%! assert(as_statement(c, behind('.', 'add', '()', {1, 2})), {int32(3)}); % by name
%! assert(as_statement(c, behind('.', 'async_stop', '()', {@(varargin) 0})), cell(1, 0)); % by name
%! assert(as_statement(c, behind('.', 'get_tool', '.', 'set_force', '()', {2})), cell(1, 0)); % by name
%! assert(as_statement(c, behind('.', 'get_tools', '()', {3}, '.', 'say', '()', {'x'})), {'tool 3: x'}); % by name
%! assert(as_statement(c, behind('.', 'get_any_tool', '()', {}, '.', 'set_force', '()', {3})), cell(1, 0)); % by name
%! force = behind('.', 'get_any_tool', '()', {}, '.', 'force'); % by name
%! assert(numArgumentsFromSubscript(c, force, 'Statement'), 0); % by name
%! assert(numArgumentsFromSubscript(c, force, 'Expression'), 1); % by name
%! assert(subsref(c, force), 3); % by name
%! assert(as_statement(c, behind('.', 'level', '.', 'PokeOutValue', '()', {1})), cell(1, 0)); % by name
%! assert(as_statement(c, behind('.', 'count', '()', {5}, '.', 'Close', '()', {})), cell(1, 0)); % by name
%! assert(as_statement(c, behind('.', 'count', '()', {5}, '.', 'Next')), {0}); % by name
%! assert(as_statement(c, behind('.', 'line', '.', 'Length', '()', {})), {10}); % by name
%! assert(as_statement(c, behind('.', 'line', '.', 'Write', '()', {1, 7})), cell(1, 0)); % by name
%! assert(as_statement(c, behind('.', 'numbers', '.', 'Connect', '()', {}, '.', 'Close')), cell(1, 0)); % by name
%! assert(numArgumentsFromSubscript(c, behind('.', 'stop'), 'Assignment'), 1); % by name
%! assert(numArgumentsFromSubscript(c, behind('.', 'not_there'), 'Statement'), 1); % by name
%! assert(numArgumentsFromSubscript(c, behind('.', 'delete'), 'Statement'), 0); % by name
%! assert(numArgumentsFromSubscript(c, behind('.', 'isvalid'), 'Expression'), 1); % by name

%!test % the same of the classes of the toolbox
%! m = bench().line;
%! assert(as_statement(m, behind('.', 'Write', '()', {1, 7})), cell(1, 0));
%! assert(as_statement(m, behind('.', 'Read', '()', {1, 1})), {7});
%! assert(as_statement(m, behind('()', {1})), {7});
%! assert(numArgumentsFromSubscript(m, behind('()', {1}), 'Assignment'), 1);
%! a = RobotRaconteurMultiDimArray([2 2 1], 1:4);
%! assert(as_statement(a, behind('.', 'dims')), {[2 2 1]});
%! assert(as_statement(a, behind('()', {2})), {2});
%! k = RobotRaconteurMap('', 5);
%! assert(as_statement(k, behind('()', {''})), {5});
%! assert(as_statement(k, behind('.', 'Count')), {1});

%!test % a function without result behind an objref
%! c = bench();
%! c.get_tool().set_force(6);
%! assert(c.get_tool().force, 6);
%! c.get_any_tool().set_force(7);
%! assert(c.get_tool().force, 7);

%!test % logging in with a password
%! a = rr_bench('guarded', 'alice', 'open sesame');
%! assert(a.add(1, 2), int32(3));
%! fails(@() rr_bench('guarded', 'alice', 'no'), 'RobotRaconteur:AuthenticationError', '');
%! RobotRaconteur.Logout(a);
%! RobotRaconteur.Authenticate(a, 'bob', 'me too');
%! assert(a.add(1, 2), int32(3));
%! s = RobotRaconteur.SubscribeService(strrep(rr_url(), 'service=bench', 'service=guarded'), 'alice', 'open sesame');
%! d = s.GetDefaultClientWait(20);
%! assert(d.add(1, 2), int32(3));
%! s.Close();
%! fails(@() rr_bench('guarded', 'alice', 5), 'RobotRaconteur:DataTypeMismatch', ...
%!   'credentials: expected a password, a containers.Map or a struct, got double');

%!test % enums by name
%! c = bench();
%! c.v_mode = 'running';
%! assert(class(c.v_mode), 'int32');
%! assert(c.v_mode, int32(3));
%! assert(RobotRaconteur.EnumName(c, 'experimental.bench.Mode', c.v_mode), 'running');
%! assert(RobotRaconteur.EnumName(c, 'experimental.bench.Mode', -1), 'failed');
%! assert(~isempty(strfind(evalc('disp(c)'), 'property Mode v_mode = running (3)')));
%! fails(@() RobotRaconteur.EnumName(c, 'experimental.bench.Mode', 12), 'RobotRaconteur:OutOfRange', ...
%!   '`experimental.bench.Mode` has no value 12: idle (0), running (3), failed (-1)');
%! fails(@() RobotRaconteur.EnumName(c, 'experimental.bench.Pose', 1), 'RobotRaconteur:InvalidArgument', ...
%!   '`experimental.bench.Pose` is not an enum');
%! try
%!   c.v_mode = 'walking';
%!   error('not thrown');
%! catch err
%!   assert(err.identifier, 'RobotRaconteur:DataTypeMismatch');
%!   assert(~isempty(strfind(err.message, '(idle, running, failed), got "walking"')), '%s', err.message);
%! end

%!test % a number that the enum does not have passes, as in all languages, and is shown as one
%! c = bench();
%! c.v_mode = 12;
%! assert(c.v_mode, int32(12));
%! assert(~isempty(strfind(evalc('disp(c)'), 'property Mode v_mode = 12 (no value of Mode)')));
%! try
%!   c.v_mode = 1.5;
%!   error('not thrown');
%! catch err
%!   assert(err.identifier, 'RobotRaconteur:DataTypeMismatch');
%! end
%! c.v_mode = 'idle';

%!test % wires and pipes that are not connected say what to do
%! c = bench();
%! fails(@() c.level.InValue, 'RobotRaconteur:InvalidOperation', ...
%!   'the wire `level` is not connected: w = object.level.Connect(); w.InValue, or object.level.PeekInValue()');
%! fails(@() c.level.OutValue, 'RobotRaconteur:InvalidOperation', 'object.level.PeekOutValue()');
%! fails(@() c.level.InValueValid, 'RobotRaconteur:InvalidOperation', 'is not connected');
%! fails(@() c.level.WaitInValueValid(1), 'RobotRaconteur:InvalidOperation', 'is not connected');
%! fails(@() addlistener(c.level, 'WireValueChanged', @disp), 'RobotRaconteur:InvalidOperation', 'is not connected');
%! fails(@() c.numbers.ReceivePacket(), 'RobotRaconteur:InvalidOperation', ...
%!   'the pipe `numbers` is not connected: p = object.numbers.Connect(-1); p.ReceivePacket()');
%! fails(@() c.numbers.Available, 'RobotRaconteur:InvalidOperation', 'is not connected');
%! fails(@() c.numbers.SendPacket(1), 'RobotRaconteur:InvalidOperation', 'p.SendPacket(packet)');
%! try
%!   c.level.OutValue = 5;
%!   error('not thrown');
%! catch err
%!   assert(err.identifier, 'RobotRaconteur:InvalidOperation');
%!   assert(~isempty(strfind(err.message, 'object.level.PokeOutValue(value)')), '%s', err.message);
%! end
%! try % by name
%!   c.level = 5; % by name
%!   error('not thrown'); % by name
%! catch err % by name
%!   assert(err.identifier, 'RobotRaconteur:MemberFormatMismatch'); % by name
%!   assert(~isempty(strfind(err.message, 'member level: it is a wire')), '%s', err.message); % by name
%! end % by name

%!test % a definition that is neither a text nor a file
%! fails(@() RobotRaconteur.RegisterServiceType('nofile'), 'RobotRaconteur:ResourceNotFound', '`nofile`');
%! fails(@() RobotRaconteur.RegisterServiceType('dir/example.robdef'), 'RobotRaconteur:ResourceNotFound', ...
%!   'there is no file `dir/example.robdef`, and it is not the text of a definition');
%! fails(@() RobotRaconteur.RegisterServiceType(''), 'RobotRaconteur:ResourceNotFound', '``');
%! fails(@() RobotRaconteur.RegisterServiceType(5), 'RobotRaconteur:DataTypeMismatch', 'got double');
%! RobotRaconteur.RegisterServiceType(sprintf('# a comment\nservice experimental.usage_a\n'));
%! RobotRaconteur.RegisterServiceType('service experimental.usage_b');

%!test % a generator without end
%! c = bench();
%! g = c.count(Inf);
%! fails(@() g.NextAll(10000), 'RobotRaconteur:OutOfSystemResource', ...
%!   'all values of `count` are more than 10000 bytes');
%! assert(g.Next() > 10);
%! g.Close();
%! assert(c.count(3).NextAll(Inf), {0; 1; 2});
%! assert(c.count(0).NextAll(), cell(0, 1));
%! fails(@() c.count(3).NextAll('much'), 'RobotRaconteur:DataTypeMismatch', '');

%!test % Last, as it ends the node: the limit of a node's sessions is that of NextAll
%! RobotRaconteur.Shutdown();
%! RobotRaconteur.SetNodeOptions(struct('ClientSessionLimit', 5000));
%! c = rr_bench();
%! fails(@() c.count(Inf).NextAll(), 'RobotRaconteur:OutOfSystemResource', ...
%!   'are more than 5000 bytes; NextAll takes a limit, and Next has none');
%! clear c
%! RobotRaconteur.Shutdown();
%! RobotRaconteur.SetNodeOptions(struct());
