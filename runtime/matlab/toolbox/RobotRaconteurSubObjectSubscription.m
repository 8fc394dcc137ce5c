classdef RobotRaconteurSubObjectSubscription < RobotRaconteurHandle
  %ROBOTRACONTEURSUBOBJECTSUBSCRIPTION An object of the clients of a subscription.
  methods
    function obj = RobotRaconteurSubObjectSubscription(number)
      obj.rr_h = number;
    end
    function client = GetDefaultClientWait(obj, seconds)
      %GETDEFAULTCLIENTWAIT The object of the client that has been connected longest; waits for
      %   it. seconds less than zero, or none: as long as it takes.
      if nargin < 2
        seconds = -1;
      end
      client = RobotRaconteurObject(rrmex('object_sub_wait', obj, seconds));
    end
    function client = GetDefaultClient(obj)
      %GETDEFAULTCLIENT The object of the client that has been connected longest; an error when
      %   there is none.
      client = GetDefaultClientWait(obj, 0);
    end
    function text = GetLastError(obj)
      %GETLASTERROR Why the object could not be found at a client; '' when all is well.
      text = rrmex('member_sub_error', obj, 'objects');
    end
    function Close(obj)
      %CLOSE End the subscription. Objects that were got stay usable.
      delete(obj);
    end
  end
end
