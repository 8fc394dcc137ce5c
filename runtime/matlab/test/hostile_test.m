% Whatever the MEX file is given, it ends with a result or with an error that has an identifier.

%!function names = all_commands()
%!  folder = fullfile(fileparts(which('rr_bench')), '..', 'src');
%!  files = dir(fullfile(folder, 'commands_*.cpp'));
%!  names = {};
%!  for i = 1:numel(files)
%!    text = fileread(fullfile(folder, files(i).name));
%!    text = text(max([1, strfind(text, 'std::vector<Command> ')]):end);
%!    found = regexp(text, '\{"(\w+)",', 'tokens');
%!    names = [names, cellfun(@(x) x{1}, found, 'UniformOutput', false)];
%!  end
%!endfunction

%!function try_all(first, others)
%!  % What ends the session, opens files or ports, or waits as told is tried elsewhere.
%!  names = setdiff(all_commands(), {'disconnect', 'close', 'log_open', 'subscribe', ...
%!                                   'subscribe_type', 'find_type', 'find_node_name', 'connect', ...
%!                                   'update_nodes', 'sleep', 'poll', 'request_timeout', 'listen_tcp', 'serve_for'});
%!  assert(numel(names) > 60);
%!  for i = 1:numel(names)
%!    for k = 1:numel(others)
%!      for count = 0:numel(others{k})
%!        try
%!          rrmex(names{i}, first{:}, others{k}{1:count});
%!        catch err
%!          assert(~isempty(strfind(err.identifier, ':')), '%s: %s', names{i}, err.message);
%!          assert(isempty(strfind(err.identifier, 'InternalError')), '%s: %s', names{i}, err.message);
%!        end
%!      end
%!    end
%!  end
%!endfunction

%!shared strange
%! strange = {{NaN, Inf, -1}, {[], [], []}, {'', '', ''}, {'level', 5, 'x'}, {{}, {{}}, {1, 'a'}}, ...
%!   {struct(), struct('a', {1, 2}), struct('dims', -1, 'array', 'x')}, {@sin, @() 1, @(x) x}, ...
%!   {intmax('uint64'), intmin('int64'), uint64(0)}, {true, false, sparse(1)}, {1i, 1 + 2i, single(1i)}, ...
%!   {zeros(2, 0, 3), ones(3, 3, 3), zeros(0, 1)}, {containers.Map(), containers.Map(1, 2), ...
%!    containers.Map('a', 5)}, {RobotRaconteurVarValue(5, 'no.such'), 'v_any', {[]}}, ...
%!   {'v_double', repmat('x', 1, 1e5), 0}, {'a_double', false, {}}, {'points', zeros(3, 2), 1}, ...
%!   {RobotRaconteurMultiDimArray(), RobotRaconteurMultiDimArray([1 1 1], {@sin}), RobotRaconteurMultiDimArray([1 1], 'x')}, ...
%!   {RobotRaconteurMultiDimArray([-1 -1 1], 1), RobotRaconteurMap('', @sin), RobotRaconteurMap()}, ...
%!   {'report', struct('count', {{}}), 1}, {'count', false, 'x'}, {'line', [1 2 3], [-1 2]}, ...
%!   {'grid', [0 0 0], [1e9 1e9 1e9]}, {'grid', [1e18 1 1], [1 1 1]}, {'numbers', 2^40, 1}};

%!test try_all({}, strange(1:4:end));
%!test try_all({uint64(0)}, strange(1:4:end));
%!test try_all({intmax('uint64')}, strange(1:4:end));
%!test try_all({-1}, strange(1:4:end));
%!test
%! c = rr_bench();
%! try_all({c.rr_h}, strange);
%! assert(c.add(1, 2), int32(3));
%!test
%! c = rr_bench();
%! w = c.level.Connect();
%! p = c.numbers.Connect();
%! g = c.count(1);
%! for h = {w.rr_h, p.rr_h, g.rr_h}
%!   try_all(h, strange(2:4:end));
%! end
%! s = RobotRaconteur.SubscribeService(['rr+tcp://127.0.0.1:', getenv('RR_TEST_PORT'), '/?service=bench']);
%! s.GetDefaultClientWait(20);
%! v = s.SubscribeWire('level');
%! q = s.SubscribePipe('numbers');
%! for h = {s.rr_h, v.rr_h, q.rr_h}
%!   try_all(h, strange(2:4:end));
%! end
%! assert(c.add(1, 2), int32(3));

%!test % values of strange classes for each property
%! c = rr_bench();
%! names = properties(c);
%! for i = 1:numel(names)
%!   for k = 1:numel(strange)
%!     for m = 1:3
%!       try
%!         rrmex('assign', c.rr_h, names{i}, strange{k}{m});
%!       catch err
%!         assert(~isempty(strfind(err.identifier, ':')), '%s: %s', names{i}, err.message);
%!         assert(isempty(strfind(err.identifier, 'InternalError')), '%s: %s', names{i}, err.message);
%!       end
%!     end
%!   end
%! end
%! assert(c.add(1, 2), int32(3));
