% Wires, pipes, memories, generators.

%!function c = bench()
%!  persistent kept
%!  if isempty(kept)
%!    kept = rr_bench();
%!  end
%!  c = kept;
%!endfunction

%!test % wires: the newest value is there without pumping
%! c = rr_bench();
%! w = c.level.Connect();
%! c.show_level(0.5);
%! assert(w.InValueValid);
%! assert(w.InValue, 0.5);
%! [is_valid, value, stamp] = w.TryGetInValue();
%! assert(is_valid && value == 0.5);
%! assert(class(stamp.seconds), 'int64');
%! assert(abs(double(w.LastValueReceivedTime.seconds) - time()) < 10);
%! assert(~w.OutValueValid);
%! w.OutValue = int8(3);
%! assert(w.OutValue, 3);
%! assert(rr_eventually(@() c.level_out() == 3));
%! assert(w.InValueLifespan, -1);
%! w.InValueLifespan = 0.05;
%! assert(w.InValueLifespan, 0.05);
%! assert(rr_eventually(@() ~w.InValueValid));
%! assert(w.IsOpen);
%! w.Close();
%! assert(~w.IsOpen);

%!error id=RobotRaconteur:ValueNotSet rr_bench().get_tool().level.Connect().InValue
%!error <member level: there is no value> rr_bench().get_tool().level.Connect().OutValue

%!test % waiting for a value
%! c = rr_bench();
%! start = tic();
%! assert(~c.get_tool().level.Connect().WaitInValueValid(0.1));
%! assert(toc(start) >= 0.1);
%! w = c.level.Connect();
%! c.async_show_level(2, []);
%! assert(w.WaitInValueValid(20));
%! assert(rr_eventually(@() w.InValue == 2));

%!test % peeks and pokes
%! c = bench();
%! c.show_level(1.5);
%! assert(c.level.PeekInValue(), 1.5);
%! [value, time] = c.level.PeekInValue();
%! assert(value, 1.5);
%! c.level.PokeOutValue(2.5);
%! assert(c.level.PeekOutValue(), 2.5);
%! assert(c.reports.PeekInValue().numbers, 1.5);

%!test % values call a function
%! c = rr_bench();
%! w = c.level.Connect();
%! rr_log_call('clear');
%! l = addlistener(w, 'WireValueChanged', @(value, time) rr_log_call(value));
%! for i = 1:20
%!   c.show_level(i);
%! end
%! assert(rr_eventually(@() numel(rr_log_call()) > 0 && rr_log_call(){end}{1} == 20));
%! delete(l);
%! c.show_level(21);
%! RobotRaconteur.Poll(0.05);
%! assert(rr_log_call(){end}{1}, 20);

%!test % pipes
%! c = rr_bench();
%! p = c.numbers.Connect(-1);
%! assert(p.Available, 0);
%! assert(p.SendPacket(4), uint32(1));
%! assert(p.ReceivePacketWait(20), 8);
%! c.send_numbers([1 2 3]);
%! assert(rr_eventually(@() p.Available == 3));
%! [has_come, packet] = p.TryReceivePacketWait(1, true);
%! assert(has_come && packet == 1);
%! assert(p.ReceivePacket(), 1);
%! [has_come, packet] = p.TryReceivePacketWait(0);
%! assert(packet, 2);
%! p.ReceivePacket();
%! [has_come, packet] = p.TryReceivePacketWait(0.05);
%! assert(~has_come && isempty(packet));
%! assert(p.IsOpen && p.Index >= 0);
%! rr_log_call('clear');
%! l = addlistener(p, 'PacketReceived', @(packet) rr_log_call(packet));
%! c.send_numbers([5 6]);
%! assert(rr_eventually(@() numel(rr_log_call()) == 2));
%! assert(rr_log_call(), {{5}, {6}});
%! p.Close();
%! assert(~p.IsOpen);

%!test % packets that are acknowledged, and ends that are closed
%! c = rr_bench();
%! p = c.numbers.Connect();
%! w = c.level.Connect();
%! rr_log_call('clear');
%! addlistener(p, 'PacketAckReceived', @(number) rr_log_call('ack', number));
%! addlistener(p, 'PipeEndpointClosed', @() rr_log_call('pipe'));
%! closed = addlistener(w, 'WireConnectionClosed', @() rr_log_call('wire'));
%! assert(~p.RequestPacketAck && ~p.IsUnreliable);
%! p.SendPacket(1);
%! p.RequestPacketAck = true;
%! assert(p.RequestPacketAck);
%! number = p.SendPacket(2);
%! assert(rr_eventually(@() numel(rr_log_call()) == 1));
%! assert(rr_log_call(), {{'ack', number}});
%! p.Close();
%! w.Close();
%! assert(rr_eventually(@() numel(rr_log_call()) == 3));
%! assert(sort({rr_log_call(){2}{1}, rr_log_call(){3}{1}}), {'pipe', 'wire'});
%! delete(closed);

%!error id=RobotRaconteur:MemberNotFound addlistener(rr_bench().level.Connect(), 'x', @() 0)
%!error id=RobotRaconteur:MemberNotFound addlistener(rr_bench().numbers.Connect(), 'x', @() 0)

%!test % a queue that is full
%! c = rr_bench();
%! p = c.numbers.Connect();
%! p.SetQueueLimit(2, 'oldest');
%! c.send_numbers(1:5);
%! assert(rr_eventually(@() p.LostCount == 3));
%! assert(p.ReceivePacket(), 4);

%!error id=RobotRaconteur:InvalidOperation rr_bench().numbers.Connect().ReceivePacket()
%!error id=RobotRaconteur:OperationTimeout rr_bench().numbers.Connect().ReceivePacketWait(0.05)
%!error <member numbers: expected double, got char> rr_bench().numbers.Connect().SendPacket('x')

%!test % memories by index
%! c = bench();
%! m = c.line;
%! assert(size(m), [10 1]);
%! assert(numel(m), 10);
%! assert(m(:), (1:10)');
%! assert(m(2:4), [2; 3; 4]);
%! assert(m(end), 10);
%! assert(m([1 3 5]), [1; 3; 5]);
%! assert(c.line(7), 7);
%! m(2:3) = [20 30];
%! assert(m(1:4), [1; 20; 30; 4]);
%! m(5) = 50;
%! c.line(6) = 60;
%! assert(c.line(5:6), [50; 60]);
%! m(:) = 1:10;
%! assert(m(:), (1:10)');
%! m(9:10) = 0;
%! assert(m(9:10), [0; 0]);

%!test % memories of several dimensions
%! c = bench();
%! m = c.grid;
%! whole = reshape(uint8(0:23), 3, 4, 2);
%! m(:) = whole;
%! assert(size(m), [3 4 2]);
%! [a, b] = size(m);
%! assert([a b], [3 8]);
%! assert(size(m, 2), 4);
%! assert(m(:, :, :), whole);
%! assert(m(:), whole(:));
%! assert(m(1:2, 2:3, 1), whole(1:2, 2:3, 1));
%! assert(m(2, [1 4], 2), whole(2, [1 4], 2));
%! assert(m(end, end, end), uint8(23));
%! m(1:2, 1, 2) = [100; 101];
%! whole(1:2, 1, 2) = [100; 101];
%! assert(m(:, :, :), whole);

%!test % memories of sizes that the interpreter does not keep: what is indexed is an array
%! c = bench();
%! m = c.slab;
%! assert(size(m), [2 3 1]);
%! assert(m(:, :, 1), [1 3 5; 2 4 6]);
%! assert(m(:, [1 3], 1), [1 5; 2 6]);
%! assert(m(:), (1:6)');
%! m(:, 2, 1) = [30; 40];
%! m(1, 1, 1) = 10;
%! assert(m(:, :, 1), [10 30 5; 2 40 6]);
%! whole = RobotRaconteurMultiDimArray([2 3 1], 1:6);
%! m(:, :, :) = whole;
%! assert(m(:, :, :), [1 3 5; 2 4 6]);
%! m = c.strip;
%! assert(size(m), [4 1]);
%! m(2:3) = [20 30];
%! assert(m(:), uint8([1; 20; 30; 4]));
%! assert(m(end), uint8(4));
%! m = c.shelf;
%! assert(size(m), [2 1]);
%! m(:, 1) = [1 4; 2 5; 3 6];
%! assert(m(:, 1), [1 4; 2 5; 3 6]);
%! assert(m(2, 1), [4; 5; 6]);

%!test % memories by positions and counts
%! c = rr_bench();
%! m = c.line;
%! assert(m.Length(), 10);
%! assert(m.Dimensions(), 10);
%! m.Write(3, [7; 8]);
%! assert(m.Read(2, 3), [2; 7; 8]);
%! m(3:4) = [3; 4];
%! assert(m.Read(1, 0), zeros(0, 1));
%! g = c.grid;
%! assert(g.DimCount(), 3);
%! assert(g.Dimensions(), [3 4 2]);
%! before = g.Read([1 1 1], [2 2 1]);
%! g.Write([1 1 1], uint8([1 2; 3 4]));
%! assert(g(1:2, 1:2, 1), uint8([1 2; 3 4]));
%! g.Write([1 1 1], before);

%!test % memories of pods and namedarrays
%! c = bench();
%! p = c.path;
%! assert(size(p), [5 1]);
%! p(2:3) = [1 2; 3 4; 5 6];
%! assert(p(3), [2; 4; 6]);
%! assert(size(p(:)), [3 5]);
%! r = c.records;
%! assert(r(2).sequence, uint32(2));
%! p(4) = [7; 8; 9];
%! assert(p(3:4), [2 7; 4 8; 6 9]);

%!test
%! m = bench().path;
%! try
%!   m(1:2) = 1:5;
%!   error('not thrown');
%! catch err
%!   assert(err.message, 'expected 2 items, got 5');
%! end

%!error id=RobotRaconteur:OutOfRange bench().line(11)
%!error <index 1 of the memory goes from 1 to 10> bench().line(0)
%!error <the memory has 3 dimensions> bench().grid(1, 2)
%!test
%! m = bench().line;
%! try
%!   m([1 3]) = [1 2];
%!   error('not thrown');
%! catch err
%!   assert(err.message, 'a memory is written without gaps');
%! end

%!test % generators
%! c = bench();
%! g = c.count(3);
%! assert(g.Next(), 0);
%! [is_there, value] = g.TryNext();
%! assert(is_there && value == 1);
%! r = g.TryNext();
%! assert(r, {true, 2});
%! r = g.TryNext();
%! assert(r{1}, false);
%! assert(c.count(3).NextAll(), {0; 1; 2});
%! s = c.running_sum(10);
%! assert(s.Next(1), 11);
%! assert(s.Next(int8(2)), 13);
%! rr_log_call('clear');
%! s.async_Next(5, @(varargin) rr_log_call(varargin{:}), 'mine');
%! assert(rr_eventually(@() numel(rr_log_call()) == 1));
%! assert(rr_log_call(){1}, {'mine', 18, []});
%! s.Close();
%! g = c.count(5);
%! g.Next();
%! g.Abort();

%!error id=RobotRaconteur:StopIteration bench().count(0).Next()
%!error <its steps take no value> bench().count(1).Next(5)
%!error <member running_sum: expected double, got char> bench().running_sum(1).Next('x')
