classdef RobotRaconteurPipeEndpoint < RobotRaconteurHandle
  %ROBOTRACONTEURPIPEENDPOINT A connected pipe. Packets are received in the background, and wait.
  properties (Dependent)
    Available
    Index
    IsOpen
    LostCount
    IsUnreliable
    RequestPacketAck
  end
  methods
    function obj = RobotRaconteurPipeEndpoint(number)
      obj.rr_h = number;
    end
    function count = get.Available(obj)
      count = rrmex('pipe_available', obj.rr_h);
    end
    function index = get.Index(obj)
      index = rrmex('pipe_about', obj.rr_h).index;
    end
    function answer = get.IsOpen(obj)
      answer = rrmex('pipe_about', obj.rr_h).is_open;
    end
    function count = get.LostCount(obj)
      count = rrmex('pipe_about', obj.rr_h).lost_count;
    end
    function answer = get.IsUnreliable(obj)
      answer = rrmex('pipe_about', obj.rr_h).is_unreliable;
    end
    function answer = get.RequestPacketAck(obj)
      answer = rrmex('pipe_about', obj.rr_h).wants_acks;
    end
    function set.RequestPacketAck(obj, is_on)
      rrmex('pipe_ask_acks', obj.rr_h, is_on);
    end
    function packet = ReceivePacket(obj)
      %RECEIVEPACKET The packet that has waited longest.
      packet = rrmex('pipe_receive', obj.rr_h);
    end
    function packet = ReceivePacketWait(obj, seconds)
      %RECEIVEPACKETWAIT The next packet, waited for; RobotRaconteur:OperationTimeout for none.
      if nargin < 2
        seconds = -1;
      end
      [has_come, packet] = rrmex('pipe_receive_wait', obj.rr_h, seconds, false);
      if ~has_come
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
      [has_come, packet] = rrmex('pipe_receive_wait', obj.rr_h, seconds, peek);
    end
    function number = SendPacket(obj, packet)
      %SENDPACKET Send a packet; its number.
      number = rrmex('pipe_send', obj.rr_h, packet);
    end
    function SetQueueLimit(obj, packets, lost)
      %SETQUEUELIMIT When so many packets wait, the 'oldest' or 'newest' is lost, or the endpoint
      %   is closed: 'close', which is the default with 65,536 packets.
      rrmex('pipe_queue_limit', obj.rr_h, packets, lost);
    end
    function listener = addlistener(obj, event, handler)
      %ADDLISTENER addlistener(endpoint, 'PacketReceived', handler): handler(packet) for each
      %   packet, from RobotRaconteur.Poll, instead of keeping it. 'PacketAckReceived':
      %   handler(number) for each packet that was sent while RequestPacketAck was true, once the
      %   service has it. 'PipeEndpointClosed': handler() when the endpoint is closed.
      switch event
        case {'PacketReceived', 'PacketReceivedEvent'}
          number = rrmex('pipe_listen', obj.rr_h, handler);
        case 'PacketAckReceived'
          number = rrmex('pipe_hear', obj.rr_h, 'acknowledged', handler);
        case 'PipeEndpointClosed'
          number = rrmex('pipe_hear', obj.rr_h, 'closed', handler);
        otherwise
          error('RobotRaconteur:MemberNotFound', ...
                'a pipe has the events PacketReceived, PacketAckReceived, PipeEndpointClosed');
      end
      listener = RobotRaconteurListener(number);
    end
    function Close(obj)
      rrmex('pipe_close', obj.rr_h);
    end
    function disp(obj)
      fprintf('  endpoint of a pipe\n');
    end
  end
end
