function steps = rr_rig_sum(start)
%RR_RIG_SUM A generator that adds what it is given; it ends above 100.
total = containers.Map({'value', 'ended'}, {start, ''});
steps = struct('next', @(value) add_to(total, value), 'close', @() note_end(total, 'closed'), ...
               'abort', @() note_end(total, 'aborted'));
end

function value = add_to(total, value)
value = total('value') + value;
if value > 100
  error('RobotRaconteur:StopIteration', 'too much');
end
total('value') = value;
end

function note_end(total, how)
total('ended') = how;
end
