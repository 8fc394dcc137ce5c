function calls(what, connect, url)
%CALLS Print the least time of some members of the test service, in microseconds.
c = connect(url);
numbers = rand(1e5, 1);
report = struct('count', int32(3), 'text', 'some text', 'numbers', (1:10)', 'mode', int32(0), ...
                'next', [], 'extra', []);
times = [least_of(@() c.v_double, 3000)
         least_of(@() set_double(c), 3000)
         least_of(@() c.add(1, 2), 3000)
         least_of(@() get_set(c, report), 600)
         least_of(@() get_set_numbers(c, numbers), 60)];
printf('%-26s %9.1f %9.1f %9.1f %9.1f %9.1f\n', what, times * 1e6);
end

function set_double(c)
  c.v_double = 2.5;
end

function value = get_set(c, value)
  c.report = value;
  value = c.report;
end

function value = get_set_numbers(c, value)
  c.a_double = value;
  value = c.a_double;
end

% Of blocks of calls, so that the cost of the clock does not count, nor what else the machine does.
function seconds = least_of(call, count)
  block = max(1, floor(count / 30));
  times = zeros(30, 1);
  for k = 1:30
    start = tic();
    for i = 1:block
      call();
    end
    times(k) = toc(start) / block;
  end
  seconds = min(times);
end
