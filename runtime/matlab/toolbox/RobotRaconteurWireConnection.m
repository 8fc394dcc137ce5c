classdef RobotRaconteurWireConnection < RobotRaconteurHandle
  %ROBOTRACONTEURWIRECONNECTION A connected wire. The newest value is received in the background.
  %   InValue is the newest value from the service, OutValue what is sent to it. InValueLifespan is
  %   in seconds, less than zero for values that do not expire.
  properties (Dependent)
    % The newest value from the service; an error when there is none.
    InValue
    % What was sent last; setting it sends a value.
    OutValue
    % Whether there is a value from the service that has not expired.
    InValueValid
    % Whether a value was sent.
    OutValueValid
    % Seconds after which a value expires; less than zero: never.
    InValueLifespan
    % When InValue was sent, by the service's clock.
    LastValueReceivedTime
    % When OutValue was sent.
    LastValueSentTime
    % False once it is closed, by either side, or lost.
    IsOpen
  end
  methods
    function obj = RobotRaconteurWireConnection(number)
      obj.rr_h = number;
    end
    function value = get.InValue(obj)
      value = rrmex('wire_in', obj);
    end
    function value = get.OutValue(obj)
      value = rrmex('wire_out', obj);
    end
    function set.OutValue(obj, value)
      rrmex('wire_set_out', obj, value);
    end
    function answer = get.InValueValid(obj)
      answer = rrmex('wire_try_in', obj);
    end
    function answer = get.OutValueValid(obj)
      answer = rrmex('wire_has_out', obj);
    end
    function seconds = get.InValueLifespan(obj)
      seconds = rrmex('wire_lifespan', obj);
    end
    function set.InValueLifespan(obj, seconds)
      rrmex('wire_lifespan', obj, seconds);
    end
    function time = get.LastValueReceivedTime(obj)
      [value, time] = rrmex('wire_in', obj);
    end
    function time = get.LastValueSentTime(obj)
      [value, time] = rrmex('wire_out', obj);
    end
    function answer = get.IsOpen(obj)
      answer = rrmex('wire_is_open', obj);
    end
    function [is_valid, value, time] = TryGetInValue(obj)
      %TRYGETINVALUE [is_valid, value, time]
      value = [];
      time = [];
      if rrmex('wire_try_in', obj)
        [is_valid, value, time] = rrmex('wire_try_in', obj);
      else
        is_valid = false;
      end
    end
    function answer = WaitInValueValid(obj, seconds)
      %WAITINVALUEVALID Wait for a value, at most so long; false when none has come.
      if nargin < 2
        seconds = -1;
      end
      answer = rrmex('wire_wait', obj, seconds);
    end
    function listener = addlistener(obj, event, handler)
      %ADDLISTENER addlistener(wire, 'WireValueChanged', handler): handler(value, time) for the
      %   newest value, from RobotRaconteur.Poll. 'WireConnectionClosed': handler() when the
      %   connection is closed.
      switch event
        case 'WireValueChanged'
          number = rrmex('wire_listen', obj, handler);
        case 'WireConnectionClosed'
          number = rrmex('wire_hear', obj, handler);
        otherwise
          error('RobotRaconteur:MemberNotFound', ...
                'a wire has the events WireValueChanged, WireConnectionClosed');
      end
      listener = RobotRaconteurListener(number);
    end
    function Close(obj)
      %CLOSE Disconnect the wire.
      rrmex('wire_close', obj);
    end
    function disp(obj)
      fprintf('  connected wire\n');
    end
  end
end
