classdef rr_child < handle
  %RR_CHILD An object of the rig that the tests serve.
  properties
    number = int32(0);
  end
  methods
    function obj = rr_child(number)
      obj.number = int32(number);
    end
    function text = name(obj)
      text = sprintf('child %d', obj.number);
    end
  end
end
