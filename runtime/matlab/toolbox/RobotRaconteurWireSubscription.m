classdef RobotRaconteurWireSubscription < RobotRaconteurHandle
  %ROBOTRACONTEURWIRESUBSCRIPTION A wire of all clients of a subscription.
  properties (Dependent)
    % The newest value, from whichever client; an error when there is none.
    InValue
    % Whether there is a value that has not expired.
    InValueValid
  end
  properties (SetAccess = private)
    % Seconds after which a value expires; less than zero: never.
    InValueLifespan = -1;
  end
  methods
    function obj = RobotRaconteurWireSubscription(number)
      obj.rr_h = number;
    end
    function value = get.InValue(obj)
      value = rrmex('wire_sub_in', obj);
    end
    function answer = get.InValueValid(obj)
      answer = rrmex('wire_sub_try_in', obj);
    end
    function SetInValueLifespan(obj, seconds)
      %SETINVALUELIFESPAN Values that came more than so many seconds ago are as none; less than
      %   zero: they do not expire.
      rrmex('wire_sub_lifespan', obj, seconds);
      obj.InValueLifespan = seconds;
    end
    function [is_valid, value, time, client] = TryGetInValue(obj)
      %TRYGETINVALUE Whether there is a value; the newest one, when it was sent, and the client
      %   that has sent it.
      value = [];
      time = [];
      client = [];
      is_valid = rrmex('wire_sub_try_in', obj);
      if is_valid
        [is_valid, value, time, client] = rrmex('wire_sub_try_in', obj);
      end
    end
    function found = GetAllInValues(obj)
      %GETALLINVALUES Cells of structs with Value, Time, Client.
      found = rrmex('wire_sub_all', obj);
    end
    function answer = WaitInValueValid(obj, seconds)
      %WAITINVALUEVALID Wait until there is a value; whether there is. seconds less than zero,
      %   or none: as long as it takes.
      if nargin < 2
        seconds = -1;
      end
      answer = rrmex('wire_sub_wait', obj, seconds);
    end
    function count = SetOutValueAll(obj, value)
      %SETOUTVALUEALL Send a value to all clients that are connected now; how many these are.
      count = rrmex('wire_sub_set_out', obj, value);
    end
    function listener = addlistener(obj, event, handler)
      %ADDLISTENER addlistener(wire, 'WireValueChanged', handler): handler(value, time, client)
      if ~strcmp(event, 'WireValueChanged')
        error('RobotRaconteur:MemberNotFound', 'a wire has the event WireValueChanged only');
      end
      listener = RobotRaconteurListener(rrmex('wire_sub_listen', obj, handler));
    end
    function text = GetLastError(obj)
      %GETLASTERROR Why the wire could not be connected at a client; '' when all is well.
      text = rrmex('member_sub_error', obj, 'wire');
    end
    function Close(obj)
      %CLOSE Disconnect the wire at all clients.
      delete(obj);
    end
  end
end
