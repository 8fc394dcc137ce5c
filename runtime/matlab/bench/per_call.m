function per_call(kind, count)
%PER_CALL Print the median, in microseconds, of reading a property, or of another kind of call.
if strcmp(kind, 'constant')
  c = RobotRaconteurObject(uint64(1));
else
  c = RobotRaconteur.ConnectService( ...
    ['rr+tcp://127.0.0.1:', getenv('RR_TEST_PORT'), '/?service=bench']);
end
times = zeros(count, 1);
switch kind
  case {'constant', 'property'}
    for i = 1:count
      t = tic();
      x = c.v_double;
      times(i) = toc(t);
    end
  case 'call'
    for i = 1:count
      t = tic();
      x = c.add(1, 2);
      times(i) = toc(t);
    end
  case 'wire'
    w = c.level.Connect();
    c.show_level(1);
    for i = 1:count
      t = tic();
      x = w.InValue;
      times(i) = toc(t);
    end
  case 'image'
    for i = 1:count
      t = tic();
      x = c.image(10e6);
      times(i) = toc(t);
      clear x
    end
  case 'copy'
    a = zeros(10e6, 1, 'uint8');
    for i = 1:count
      t = tic();
      x = a;
      x(1) = 1;
      times(i) = toc(t);
    end
end
fprintf('%.1f\n', 1e6 * median(times));
end
