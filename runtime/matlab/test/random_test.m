% Definitions and values by chance go from a service to Octave and back, and are the same there. The
% service prints none of them; its first seed is ROBDEF_RANDOM_SEED, 20260201 if that is not set, and
% the next one is each next definition's.

%!function use(number)
%!  c = RobotRaconteur.ConnectService(sprintf('rr+tcp://127.0.0.1:%s/?service=board%d', ...
%!    getenv('RR_TEST_PORT'), number));
%!  i = 0;
%!  while isprop(c, sprintf('p%d', i))
%!    value = c.(sprintf('p%d', i));
%!    c.(sprintf('q%d', i)) = value;
%!    echoed = c.(sprintf('echo%d', i))(value);
%!    assert(rr_isequal(echoed, value), 'echo%d gives something else', i);
%!    i = i + 1;
%!  end
%!  level = c.level;
%!  level.PokeOutValue(level.PeekInValue());
%!  for name = {'items', 'grid'}
%!    m = c.(name{1});
%!    dims = rrmex('memory_dims', c.rr_h, name{1});
%!    content = rrmex('memory_read', c.rr_h, name{1}, zeros(size(dims)), dims);
%!    rrmex('memory_write', c.rr_h, name{1}, zeros(size(dims)), content);
%!  end
%!  assert(strcmp(c.difference(), ''), 'other than before:%s, in\n%s', c.difference(), servicedef(c));
%!endfunction

%!test
%! failed = {};
%! for number = 0:199
%!   try
%!     use(number);
%!   catch err
%!     failed{end + 1} = sprintf('board%d: %s', number, err.message);
%!   end
%! end
%! assert(isempty(failed), '%s', strjoin(failed, "\n"));
