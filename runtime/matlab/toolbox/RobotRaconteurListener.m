classdef RobotRaconteurListener
  %ROBOTRACONTEURLISTENER A function that is called for events. delete(listener) ends it; it also
  %   ends with its connection, but not when the variable goes.
  properties (Hidden)
    rr_number = uint64(0);
  end
  methods
    function obj = RobotRaconteurListener(number)
      obj.rr_number = number;
    end
    function delete(obj)
      rrmex('unlisten', obj.rr_number);
    end
  end
end
