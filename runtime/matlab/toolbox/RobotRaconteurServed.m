classdef RobotRaconteurServed < RobotRaconteurHandle
  %ROBOTRACONTEURSERVED An object that this interpreter serves.
  %   s = RobotRaconteurServed(type, obj) serves obj, a handle object or a struct of function
  %   handles, as an object of this type, which RobotRaconteur.RegisterServiceType has made known.
  %   A member is a property or method of the handle object of the same name; in a struct a
  %   function handle: property = f() and set_property(value), or a value that does not change.
  %   An objref `tool` is the method tool(index) or get_tool(index): it gives such an object, a
  %   RobotRaconteurServed, or [] for none. A generator function gives a cell array of values, or
  %   a struct with next: a function that gives the next value and ends with the error
  %   RobotRaconteur:StopIteration; close and abort are called at the end. What clients send by a
  %   wire or pipe `force` is told to on_force(value, client). See also RobotRaconteur.
  methods
    function obj = RobotRaconteurServed(type, served)
      obj.rr_h = rrmex('serve', type, ...
        @(kind, name, varargin) rr_served_call(served, kind, name, varargin{:}));
      [names, declarations] = rrmex('served_members', obj.rr_h);
      for i = 1:numel(names)
        kind = strtok(declarations{i});
        if any(strcmp(kind, {'wire', 'pipe'})) && rr_served_has(served, ['on_', names{i}])
          rrmex('served_listen', obj.rr_h, names{i});
        elseif strcmp(kind, 'memory') && rr_served_has(served, names{i})
          rrmex('served_memory', obj.rr_h, names{i}, served.(names{i}));
        end
      end
    end
    function Fire(obj, event, varargin)
      %FIRE Send an event to all clients.
      rrmex('fire', obj.rr_h, event, varargin{:});
    end
    function SetInValue(obj, wire, value)
      %SETINVALUE Send the value of a wire to all clients, and to those that connect later.
      rrmex('served_in', obj.rr_h, wire, value);
    end
    function [value, time] = OutValue(obj, wire)
      %OUTVALUE The newest value that any client has sent by a wire; [] for none.
      [value, time] = rrmex('served_out', obj.rr_h, wire);
    end
    function SendPacket(obj, pipe, packet)
      %SENDPACKET Send a packet to all endpoints of a pipe.
      rrmex('served_send', obj.rr_h, pipe, packet);
    end
    function result = CallBack(obj, callback, client, varargin)
      %CALLBACK Call the function of one client, RobotRaconteur.CurrentClient() for example.
      result = rrmex('call_back', obj.rr_h, callback, client, varargin{:});
    end
    function content = Memory(obj, name)
      %MEMORY What a memory holds now. It is kept here, from the property of its name on.
      content = rrmex('served_memory', obj.rr_h, name);
    end
    function SetMemory(obj, name, content)
      %SETMEMORY Give a memory another content.
      rrmex('served_memory', obj.rr_h, name, content);
    end
  end
end
