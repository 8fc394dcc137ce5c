classdef RobotRaconteurPipeSubscription < RobotRaconteurHandle
  %ROBOTRACONTEURPIPESUBSCRIPTION A pipe of all clients of a subscription.
  properties (Dependent)
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
      [packet, client] = ReceivePacketWait(obj, 0);
    end
    function [has_come, packet, client] = TryReceivePacketWait(obj, seconds)
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
      text = rrmex('member_sub_error', obj, 'pipe');
    end
    function Close(obj)
      delete(obj);
    end
  end
end
