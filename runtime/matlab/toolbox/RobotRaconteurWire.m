classdef RobotRaconteurWire < handle
  %ROBOTRACONTEURWIRE A wire of an object: connect it, or peek and poke.
  properties (Hidden)
    rr_object = [];
    rr_name = '';
  end
  properties (Dependent, Hidden)
    % What a connection has, so that a wire that is not connected says what to do.
    InValue
    OutValue
    InValueValid
    OutValueValid
    InValueLifespan
    LastValueReceivedTime
    LastValueSentTime
  end
  methods
    function obj = RobotRaconteurWire(object, name)
      obj.rr_object = object;
      obj.rr_name = name;
    end
    function connection = Connect(obj)
      %CONNECT From now on values arrive in the background.
      connection = RobotRaconteurWireConnection(rrmex('wire_connect', obj.rr_object, obj.rr_name));
    end
    function [value, time] = PeekInValue(obj)
      %PEEKINVALUE The service's value now, and when it was set.
      [value, time] = rrmex('wire_peek', obj.rr_object, obj.rr_name, false);
    end
    function [value, time] = PeekOutValue(obj)
      %PEEKOUTVALUE The value that the service has received last.
      [value, time] = rrmex('wire_peek', obj.rr_object, obj.rr_name, true);
    end
    function PokeOutValue(obj, value)
      %POKEOUTVALUE Send a value without connecting.
      rrmex('wire_poke', obj.rr_object, obj.rr_name, value);
    end
    function value = get.InValue(obj)
      value = rr_not_connected(obj, 'w.InValue', 'PeekInValue()');
    end
    function value = get.OutValue(obj)
      value = rr_not_connected(obj, 'w.OutValue', 'PeekOutValue()');
    end
    function set.OutValue(obj, value)
      rr_not_connected(obj, 'w.OutValue = value', 'PokeOutValue(value)');
    end
    function value = get.InValueValid(obj)
      value = rr_not_connected(obj, 'w.InValueValid');
    end
    function value = get.OutValueValid(obj)
      value = rr_not_connected(obj, 'w.OutValueValid');
    end
    function value = get.InValueLifespan(obj)
      value = rr_not_connected(obj, 'w.InValueLifespan');
    end
    function set.InValueLifespan(obj, value)
      rr_not_connected(obj, 'w.InValueLifespan = seconds');
    end
    function value = get.LastValueReceivedTime(obj)
      value = rr_not_connected(obj, 'w.LastValueReceivedTime');
    end
    function value = get.LastValueSentTime(obj)
      value = rr_not_connected(obj, 'w.LastValueSentTime');
    end
    function varargout = TryGetInValue(obj)
      %TRYGETINVALUE Of a connection: obj.wire.Connect().
      varargout = {rr_not_connected(obj, 'w.TryGetInValue()', 'PeekInValue()')};
    end
    function value = WaitInValueValid(obj, varargin)
      %WAITINVALUEVALID Of a connection: obj.wire.Connect().
      value = rr_not_connected(obj, 'w.WaitInValueValid(seconds)');
    end
    function value = addlistener(obj, varargin)
      %ADDLISTENER Of a connection: obj.wire.Connect().
      value = rr_not_connected(obj, 'addlistener(w, ''WireValueChanged'', handler)');
    end
    function disp(obj)
      fprintf('  wire %s\n', obj.rr_name);
    end
  end
  methods (Access = private)
    function value = rr_not_connected(obj, use, instead)
      % Always an error; its result stands where one is assigned.
      value = [];
      way = '';
      if nargin > 2
        way = sprintf(', or object.%s.%s', obj.rr_name, instead);
      end
      error('RobotRaconteur:InvalidOperation', ...
            'the wire `%s` is not connected: w = object.%s.Connect(); %s%s', obj.rr_name, obj.rr_name, ...
            use, way);
    end
  end
end
