classdef RobotRaconteurPipeSubscription < RobotRaconteurHandle
  %ROBOTRACONTEURPIPESUBSCRIPTION A pipe of all clients of a subscription.
  properties (Dependent)
    % How many packets wait to be received.
    Available
  end
  methods
    function obj = RobotRaconteurPipeSubscription(number)
      obj.rr_h = number;
    end
    function count = get.Available(obj)
      count = rrmex('pipe_sub_available', obj);
    end
    function [packet, client] = ReceivePacketWait(obj, seconds)
      %RECEIVEPACKETWAIT Wait for a packet: the packet, and the client that has sent it. seconds
      %   less than zero, or none: as long as it takes; otherwise OperationTimeout.
      if nargin < 2
        seconds = -1;
      end
      [has_come, packet, client] = rrmex('pipe_sub_receive', obj, seconds);
      if ~has_come
        RobotRaconteur.ThrowError(struct('name', 'RobotRaconteur.OperationTimeout', ...
                                         'message', 'no packet has come'));
      end
    end
    function [packet, client] = ReceivePacket(obj)
      %RECEIVEPACKET The packet that has waited longest, and its client; OperationTimeout when
      %   none waits.
      [packet, client] = ReceivePacketWait(obj, 0);
    end
    function [has_come, packet, client] = TryReceivePacketWait(obj, seconds)
      %TRYRECEIVEPACKETWAIT Wait for a packet, by default not at all: whether one has come, the
      %   packet, its client.
      if nargin < 2
        seconds = 0;
      end
      [has_come, packet, client] = rrmex('pipe_sub_receive', obj, seconds);
    end
    function count = SendPacketAll(obj, packet)
      %SENDPACKETALL Send to all clients that are connected now; how many these are.
      count = rrmex('pipe_sub_send', obj, packet);
    end
    function text = GetLastError(obj)
      %GETLASTERROR Why the pipe could not be connected at a client; '' when all is well.
      text = rrmex('member_sub_error', obj, 'pipe');
    end
    function Close(obj)
      %CLOSE Disconnect the endpoints at all clients.
      delete(obj);
    end
  end
end
