classdef RobotRaconteurHandle < handle
  %ROBOTRACONTEURHANDLE What the MEX file holds for the user, until the last variable goes.
  properties (Hidden)
    rr_h = uint64(0);
  end
  methods
    function delete(obj)
      if obj.rr_h ~= 0
        rrmex('close', obj.rr_h);
        obj.rr_h = uint64(0);
      end
    end
  end
end
