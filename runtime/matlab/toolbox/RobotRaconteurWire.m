classdef RobotRaconteurWire < handle
  %ROBOTRACONTEURWIRE A wire of an object: connect it, or peek and poke.
  properties (Hidden)
    rr_object = [];
    rr_name = '';
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
    function disp(obj)
      fprintf('  wire %s\n', obj.rr_name);
    end
  end
end
