classdef rr_rig < handle
  %RR_RIG What the tests serve from Octave: properties and methods named as the definition's members.
  properties
    speed = 1;
    count = 2;
    note = [];
    mode = 5;
    title = 'the rig';
    buffer = [0; 1; 2; 3];
    grid = int16([1 2 3; 4 5 6]);
    stopped = 0;
    forces = [];
    packets = [];
    served = [];
  end
  methods
    function sum = add(obj, a, b)
      sum = a + b;
    end
    function stop(obj)
      obj.stopped = obj.stopped + 1;
    end
    function jam(obj, text)
      error('experimental:rig:Jam', '%s', text);
    end
    function value = echo(obj, value)
    end
    function values = count_to(obj, limit)
      values = num2cell(0:double(limit) - 1);
    end
    function steps = sum(obj, start)
      steps = rr_rig_sum(start);
    end
    function fire(obj, count)
      for i = 1:count
        obj.served.Fire('changed', i, [i; 2; 3]);
      end
    end
    function answer = ask_back(obj, question)
      answer = obj.served.CallBack('ask', RobotRaconteur.CurrentClient(), question);
    end
    function child = child(obj)
      child = rr_child(1);
    end
    function child = children(obj, index)
      child = [];
      if index >= 0
        child = rr_child(index);
      end
    end
    function child = get_by_name(obj, index)
      child = struct('number', int32(numel(index)), 'name', @() ['named ', index]);
    end
    function child = anything(obj)
      child = RobotRaconteurServed('experimental.rig.Child', rr_child(99));
    end
    function on_force(obj, value, client)
      obj.forces = [obj.forces, value];
    end
    function on_samples(obj, packet, client)
      obj.packets = [obj.packets, packet];
      obj.served.SendPacket('samples', packet);
    end
  end
end
