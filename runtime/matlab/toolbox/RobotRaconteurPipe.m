classdef RobotRaconteurPipe < handle
  %ROBOTRACONTEURPIPE A pipe of an object: endpoint = obj.pipe.Connect(-1).
  properties (Hidden)
    rr_object = [];
    rr_name = '';
  end
  properties (Dependent, Hidden)
    % What an endpoint has, so that a pipe that is not connected says what to do.
    Available
  end
  methods
    function obj = RobotRaconteurPipe(object, name)
      obj.rr_object = object;
      obj.rr_name = name;
    end
    function endpoint = Connect(obj, index)
      %CONNECT An endpoint with this index; -1, and none, leave it to the service.
      if nargin < 2
        index = -1;
      end
      endpoint = RobotRaconteurPipeEndpoint( ...
        rrmex('pipe_connect', obj.rr_object, obj.rr_name, index));
    end
    function value = get.Available(obj)
      value = rr_not_connected(obj, 'p.Available');
    end
    function value = ReceivePacket(obj)
      %RECEIVEPACKET Of an endpoint: obj.pipe.Connect(-1).
      value = rr_not_connected(obj, 'p.ReceivePacket()');
    end
    function value = ReceivePacketWait(obj, varargin)
      %RECEIVEPACKETWAIT Of an endpoint: obj.pipe.Connect(-1).
      value = rr_not_connected(obj, 'p.ReceivePacketWait(seconds)');
    end
    function varargout = TryReceivePacketWait(obj, varargin)
      %TRYRECEIVEPACKETWAIT Of an endpoint: obj.pipe.Connect(-1).
      varargout = {rr_not_connected(obj, 'p.TryReceivePacketWait(seconds)')};
    end
    function value = SendPacket(obj, varargin)
      %SENDPACKET Of an endpoint: obj.pipe.Connect(-1).
      value = rr_not_connected(obj, 'p.SendPacket(packet)');
    end
    function value = addlistener(obj, varargin)
      %ADDLISTENER Of an endpoint: obj.pipe.Connect(-1).
      value = rr_not_connected(obj, 'addlistener(p, ''PacketReceived'', handler)');
    end
    function disp(obj)
      fprintf('  pipe %s\n', obj.rr_name);
    end
  end
  methods (Access = private)
    function value = rr_not_connected(obj, use)
      % Always an error; its result stands where one is assigned.
      value = [];
      error('RobotRaconteur:InvalidOperation', ...
            'the pipe `%s` is not connected: p = object.%s.Connect(-1); %s', obj.rr_name, obj.rr_name, use);
    end
  end
end
