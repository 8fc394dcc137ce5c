classdef RobotRaconteurSubObjectSubscription < RobotRaconteurHandle
  %ROBOTRACONTEURSUBOBJECTSUBSCRIPTION An object of the clients of a subscription.
  methods
    function obj = RobotRaconteurSubObjectSubscription(number)
      obj.rr_h = number;
    end
    function client = GetDefaultClientWait(obj, seconds)
      if nargin < 2
        seconds = -1;
      end
      client = RobotRaconteurObject(rrmex('object_sub_wait', obj, seconds));
    end
    function client = GetDefaultClient(obj)
      client = GetDefaultClientWait(obj, 0);
    end
    function text = GetLastError(obj)
      text = rrmex('member_sub_error', obj, 'objects');
    end
    function Close(obj)
      delete(obj);
    end
  end
end
