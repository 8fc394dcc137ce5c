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
  %   wire or pipe `force` is told to on_force(value, client), that one has connected to
  %   connected_force(client). What a wire's clients peek at is what was sent last, or what
  %   peek_in_force() and peek_out_force() give. See also RobotRaconteur.
  methods
    function obj = RobotRaconteurServed(type, served)
      obj.rr_h = rrmex('serve', type, ...
        @(kind, name, varargin) rr_served_call(served, kind, name, varargin{:}));
      [names, declarations] = rrmex('served_members', obj.rr_h);
      for i = 1:numel(names)
        kind = strtok(declarations{i});
        if any(strcmp(kind, {'wire', 'pipe'}))
          rr_listen(obj, served, kind, names{i});
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
    function SendPacket(obj, pipe, packet, wants_ack)
      %SENDPACKET Send a packet to all endpoints of a pipe; with wants_ack clients acknowledge it.
      if nargin < 4
        wants_ack = false;
      end
      rrmex('served_send', obj.rr_h, pipe, packet, wants_ack);
    end
    function found = Endpoints(obj, pipe)
      %ENDPOINTS The endpoints of a pipe that are open: a column of structs with client and index.
      found = rrmex('served_endpoints', obj.rr_h, pipe);
    end
    function SendPacketTo(obj, pipe, endpoint, packet, wants_ack)
      %SENDPACKETTO Send a packet to one of Endpoints.
      if nargin < 5
        wants_ack = false;
      end
      rrmex('served_send_to', obj.rr_h, pipe, endpoint, packet, wants_ack);
    end
    function Disconnect(obj, name)
      %DISCONNECT End all connections of a wire, or all endpoints of a pipe.
      rrmex('served_disconnect', obj.rr_h, name);
    end
    function EnableMonitor(obj)
      %ENABLEMONITOR Clients can have the object to themselves, by MonitorEnter. Before it is
      %   offered.
      rrmex('served_monitor', obj.rr_h);
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
  methods (Access = private)
    function rr_listen(obj, served, kind, name)
      kinds = {'on', 'connected'};
      if strcmp(kind, 'wire')
        kinds = [kinds, {'peek_in', 'peek_out'}];
      end
      kinds = kinds(cellfun(@(one) rr_served_has(served, [one, '_', name]), kinds));
      if ~isempty(kinds)
        rrmex('served_listen', obj.rr_h, name, kinds);
      end
    end
  end
end
