classdef RobotRaconteurPipeEndpoint < RobotRaconteurHandle
  %ROBOTRACONTEURPIPEENDPOINT A connected pipe. Packets are received in the background, and wait.
  properties (Dependent)
    % How many packets wait to be received.
    Available
    % Its number among the endpoints of the pipe.
    Index
    % False once it is closed, by either side, or lost.
    IsOpen
    % How many packets were lost because the queue was full.
    LostCount
    % Whether packets may be lost or come in another order.
    IsUnreliable
    % Whether the service acknowledges packets that are sent; false at first.
    RequestPacketAck
  end
  methods
    function obj = RobotRaconteurPipeEndpoint(number)
      obj.rr_h = number;
    end
    function count = get.Available(obj)
      count = rrmex('pipe_available', obj);
    end
    function index = get.Index(obj)
      index = rrmex('pipe_about', obj).index;
    end
    function answer = get.IsOpen(obj)
      answer = rrmex('pipe_about', obj).is_open;
    end
    function count = get.LostCount(obj)
      count = rrmex('pipe_about', obj).lost_count;
    end
    function answer = get.IsUnreliable(obj)
      answer = rrmex('pipe_about', obj).is_unreliable;
    end
    function answer = get.RequestPacketAck(obj)
      answer = rrmex('pipe_about', obj).wants_acks;
    end
    function set.RequestPacketAck(obj, is_on)
      rrmex('pipe_ask_acks', obj, is_on);
    end
    function packet = ReceivePacket(obj)
      %RECEIVEPACKET The packet that has waited longest.
      packet = rrmex('pipe_receive', obj);
    end
    function packet = ReceivePacketWait(obj, seconds)
      %RECEIVEPACKETWAIT The next packet, waited for; RobotRaconteur:OperationTimeout for none,
      %   InvalidOperation when the endpoint is closed.
      if nargin < 2
        seconds = -1;
      end
      [has_come, packet] = rrmex('pipe_receive_wait', obj, seconds, false);
      if ~has_come && ~obj.IsOpen
        RobotRaconteur.ThrowError(struct('name', 'RobotRaconteur.InvalidOperation', ...
                                         'message', 'the pipe endpoint is closed'));
      elseif ~has_come
        RobotRaconteur.ThrowError(struct('name', 'RobotRaconteur.OperationTimeout', ...
                                         'message', 'no packet has come'));
      end
    end
    function [has_come, packet] = TryReceivePacketWait(obj, seconds, peek)
      %TRYRECEIVEPACKETWAIT [has_come, packet]; with peek the packet stays.
      if nargin < 2
        seconds = 0;
      end
      if nargin < 3
        peek = false;
      end
      [has_come, packet] = rrmex('pipe_receive_wait', obj, seconds, peek);
    end
    function number = SendPacket(obj, packet)
      %SENDPACKET Send a packet; its number.
      number = rrmex('pipe_send', obj, packet);
    end
    function SetQueueLimit(obj, packets, lost)
      %SETQUEUELIMIT When so many packets wait, the 'oldest' or 'newest' is lost, or the endpoint
      %   is closed: 'close', which is the default with 65,536 packets.
      rrmex('pipe_queue_limit', obj, packets, lost);
    end
    function listener = addlistener(obj, event, handler)
      %ADDLISTENER addlistener(endpoint, 'PacketReceived', handler): handler(packet) for each
      %   packet, from RobotRaconteur.Poll, instead of keeping it. 'PacketAckReceived':
      %   handler(number) for each packet that was sent while RequestPacketAck was true, once the
      %   service has it. 'PipeEndpointClosed': handler() when the endpoint is closed.
      switch event
        case {'PacketReceived', 'PacketReceivedEvent'}
          number = rrmex('pipe_listen', obj, handler);
        case 'PacketAckReceived'
          number = rrmex('pipe_hear', obj, 'acknowledged', handler);
        case 'PipeEndpointClosed'
          number = rrmex('pipe_hear', obj, 'closed', handler);
        otherwise
          error('RobotRaconteur:MemberNotFound', ...
                'a pipe has the events PacketReceived, PacketAckReceived, PipeEndpointClosed');
      end
      listener = RobotRaconteurListener(number);
    end
    function Close(obj)
      %CLOSE Disconnect the endpoint. Packets that have come can still be received.
      rrmex('pipe_close', obj);
    end
    function disp(obj)
      fprintf('  endpoint of a pipe\n');
    end
  end
end
