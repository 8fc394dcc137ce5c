classdef RobotRaconteurWireSubscription < RobotRaconteurHandle
  %ROBOTRACONTEURWIRESUBSCRIPTION A wire of all clients of a subscription.
  properties (Dependent)
    InValue
    InValueValid
  end
  properties (SetAccess = private)
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
      rrmex('wire_sub_lifespan', obj, seconds);
      obj.InValueLifespan = seconds;
    end
    function [is_valid, value, time, client] = TryGetInValue(obj)
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
      delete(obj);
    end
  end
end
