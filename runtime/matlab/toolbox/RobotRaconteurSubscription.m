classdef RobotRaconteurSubscription < RobotRaconteurHandle
  %ROBOTRACONTEURSUBSCRIPTION Connections to services that come and go.
  methods
    function obj = RobotRaconteurSubscription(number)
      obj.rr_h = number;
    end
    function client = GetDefaultClient(obj)
      %GETDEFAULTCLIENT The client that is connected longest.
      client = RobotRaconteurObject(rrmex('sub_default', obj));
    end
    function [has_one, client] = TryGetDefaultClient(obj)
      %TRYGETDEFAULTCLIENT [has_one, client]
      number = rrmex('sub_try_default', obj);
      has_one = number ~= 0;
      client = [];
      if has_one
        client = RobotRaconteurObject(number);
      end
    end
    function client = GetDefaultClientWait(obj, seconds)
      %GETDEFAULTCLIENTWAIT The same, waited for; RobotRaconteur:OperationTimeout with the reason.
      if nargin < 2
        seconds = -1;
      end
      client = RobotRaconteurObject(rrmex('sub_wait', obj, seconds));
    end
    function found = GetConnectedClients(obj)
      %GETCONNECTEDCLIENTS Cells of structs with NodeID, ServiceName, Client.
      [found, numbers] = rrmex('sub_clients', obj);
      for i = 1:numel(found)
        found{i}.Client = RobotRaconteurObject(numbers{i});
      end
    end
    function found = GetClientConnectFailures(obj)
      %GETCLIENTCONNECTFAILURES Cells of structs with URLs, Message, Identifier, Failures.
      found = rrmex('sub_failures', obj);
    end
    function claim = ClaimClient(obj, client)
      %CLAIMCLIENT Keep a client when the subscription is closed; ReleaseClient gives it back.
      claim = rrmex('sub_claim', obj, client.rr_h);
    end
    function ReleaseClient(obj, claim)
      %RELEASECLIENT Give back a client of ClaimClient; it is closed if the subscription is.
      rrmex('sub_release', obj, claim);
    end
    function UpdateServiceURL(obj, urls)
      %UPDATESERVICEURL From now on these URLs, alternatives of one service. A connection stays
      %   while its URL is among them.
      rrmex('sub_update_urls', obj, urls);
    end
    function UpdateServiceByType(obj, types, filter)
      %UPDATESERVICEBYTYPE From now on services of these types that pass the filter. Connections
      %   to those that match stay.
      if nargin < 3
        filter = struct();
      end
      rrmex('sub_update_types', obj, types, filter);
    end
    function SetConnectRetryDelay(obj, seconds)
      %SETCONNECTRETRYDELAY Seconds from a failure, or the loss of a connection, to the next
      %   attempt.
      rrmex('sub_retry_delay', obj, seconds);
    end
    function wire = SubscribeWire(obj, name, path)
      %SUBSCRIBEWIRE A wire of all clients, now and later; path as '*.tool'.
      if nargin < 3
        path = '';
      end
      wire = RobotRaconteurWireSubscription(rrmex('wire_sub', obj, name, path));
    end
    function pipe = SubscribePipe(obj, name, path, most)
      %SUBSCRIBEPIPE A pipe likewise; at most so many packets wait, 0 for any number.
      if nargin < 3
        path = '';
      end
      if nargin < 4
        most = 0;
      end
      pipe = RobotRaconteurPipeSubscription(rrmex('pipe_sub', obj, name, path, most));
    end
    function objects = SubscribeSubObject(obj, path)
      %SUBSCRIBESUBOBJECT An object below the root, as '*.tool'.
      objects = RobotRaconteurSubObjectSubscription(rrmex('object_sub', obj, path));
    end
    function listener = addlistener(obj, event, handler)
      %ADDLISTENER ClientConnected and ClientDisconnected: handler(id, why); ClientConnectFailed:
      %   handler(url, why). From RobotRaconteur.Poll.
      listener = RobotRaconteurListener(rrmex('sub_listen', obj, event, handler));
    end
    function Close(obj)
      %CLOSE End the subscription and all clients that nobody has claimed.
      rrmex('sub_close', obj);
    end
    function disp(obj)
      fprintf('  subscription\n');
    end
  end
end
