classdef RobotRaconteur
  %ROBOTRACONTEUR Clients of Robot Raconteur services, and services.
  %   c = RobotRaconteur.ConnectService(url) connects to a service by nothing but its URL; what it
  %   has is known from the service. methods(RobotRaconteur) lists what else there is. Times are in
  %   seconds.
  methods (Static)
    function obj = Connect(varargin)
      %CONNECT The same as ConnectService, as it was called in 2011.
      obj = RobotRaconteur.ConnectService(varargin{:});
    end
    function obj = ConnectService(url, username, credentials, object_type)
      %CONNECTSERVICE c = RobotRaconteur.ConnectService(url, username, credentials, object_type)
      %   url may be a cell array of several ways to one service. credentials is the password, or
      %   for other ways of logging in a containers.Map or a struct, as struct('password', 'secret').
      if nargin < 2
        username = '';
      end
      if nargin < 3
        credentials = [];
      end
      if nargin < 4
        object_type = '';
      end
      obj = RobotRaconteurObject(rrmex('connect', url, username, credentials, object_type));
    end
    function DisconnectService(obj)
      %DISCONNECTSERVICE End the session of an object. It also ends when no variable is left of it.
      if isa(obj, 'RobotRaconteurStub')
        rrmex('disconnect', obj);
      else
        obj.Close();
      end
    end
    function Authenticate(obj, username, credentials)
      %AUTHENTICATE Log in at the service of an object, with credentials as of ConnectService.
      rrmex('authenticate', obj, username, credentials);
    end
    function Logout(obj)
      %LOGOUT Log out: the session goes on without a user, where the service allows that.
      rrmex('logout', obj);
    end
    function [found, varvalues] = GetServiceAttributes(obj)
      %GETSERVICEATTRIBUTES What the service tells of itself, as a containers.Map; as it was when
      %   the object was connected. varvalues has each as a RobotRaconteurVarValue, which tells its
      %   type.
      [found, varvalues] = rrmex('attributes', obj);
    end
    function listener = AddClientServiceListener(obj, handler)
      %ADDCLIENTSERVICELISTENER Hear of what happens to the session of an object, from Poll:
      %   handler('ClientClosed', why) when it has ended, whoever ended it,
      %   handler('ServicePathReleased', path) when the service has released an object.
      listener = RobotRaconteurListener(rrmex('session_listen', obj, handler));
    end
    function type = FindObjectType(obj, member, varargin)
      %FINDOBJECTTYPE RobotRaconteur.FindObjectType(obj, objref, index): what type of object is
      %   there, as the service says, without getting it.
      type = rrmex('find_object_type', obj, member, varargin{:});
    end

    function count = Poll(seconds)
      %POLL Call the handlers of what has come: events, packets, values, ended calls.
      %   Waits up to so long for the first; returns how many were called.
      if nargin < 1
        seconds = 0;
      end
      count = rrmex('poll', seconds);
    end
    function count = ProcessRequests()
      %PROCESSREQUESTS The same as Poll(0).
      count = rrmex('poll', 0);
    end
    function EnableEvents(obj)
      %ENABLEEVENTS Events are delivered, which they are anyway, and at the prompt without Poll.
      %   Octave calls the handlers while it waits for input. MATLAB calls them from a timer, every
      %   0.05 s while it is idle, and in pause and drawnow. Shutdown() ends both.
      rrmex('events', obj, true);
      rr_prompt(true);
    end
    function DisableEvents(obj)
      %DISABLEEVENTS Events of the object's session are dropped until EnableEvents.
      rrmex('events', obj, false);
    end

    function RequestObjectLock(obj, kind)
      %REQUESTOBJECTLOCK Keep others from an object: 'User' (all sessions of the user) or 'Client'.
      if nargin < 2
        kind = 'User';
      end
      rrmex('lock', obj, kind);
    end
    function ReleaseObjectLock(obj)
      %RELEASEOBJECTLOCK End the lock of this user at an object; another user's needs the
      %   privilege objectlockoverride.
      rrmex('unlock', obj);
    end
    function MonitorEnter(obj, seconds)
      %MONITORENTER Wait until this session alone may use the object.
      if nargin < 2
        seconds = -1;
      end
      rrmex('monitor_enter', obj, seconds);
    end
    function MonitorExit(obj)
      %MONITOREXIT Leave the monitor of an object.
      rrmex('monitor_exit', obj);
    end

    function made = CreateStructure(obj, name)
      %CREATESTRUCTURE A struct, pod or namedarray of a definition with all fields: 0, '', [].
      made = rrmex('create', obj, name);
    end
    function found = GetConstants(obj, service)
      %GETCONSTANTS Constants and enums of a definition, in a struct; those of its structs and
      %   objects are structs in it.
      if nargin < 2
        name = rrmex('about', obj).type;
        service = name(1:find(name == '.', 1, 'last') - 1);
      end
      found = rrmex('constants', obj, service);
    end
    function name = EnumName(obj, type, value)
      %ENUMNAME The name of an enum's value: RobotRaconteur.EnumName(c, 'example.arm.Mode', c.mode).
      %   RobotRaconteur:OutOfRange for a number that the enum does not have. The service may send
      %   such a number, and take one, as in all languages.
      name = rrmex('enum_name', obj, type, value);
    end
    function names = GetPulledServiceTypes(obj)
      %GETPULLEDSERVICETYPES Names of the definitions that the service has sent.
      names = rrmex('definitions', obj);
    end
    function text = GetPulledServiceType(obj, name)
      %GETPULLEDSERVICETYPE The text of one of them.
      text = rrmex('definition', obj, name);
    end

    function sub = SubscribeService(url, username, credentials, object_type)
      %SUBSCRIBESERVICE Keep a connection to a service, also when it goes and comes back.
      if nargin < 2
        username = '';
      end
      if nargin < 3
        credentials = [];
      end
      if nargin < 4
        object_type = '';
      end
      sub = RobotRaconteurSubscription( ...
        rrmex('subscribe', url, username, credentials, object_type));
    end
    function sub = SubscribeServiceByType(types, filter)
      %SUBSCRIBESERVICEBYTYPE The same for all services of these types that are found. filter is a
      %   struct with any of Nodes, ServiceNames, TransportSchemes, Attributes, MaxConnections.
      if nargin < 2
        filter = struct();
      end
      sub = RobotRaconteurSubscription(rrmex('subscribe_type', types, filter));
    end
    function sub = SubscribeServiceInfo2(types, filter)
      %SUBSCRIBESERVICEINFO2 Which services there are, without connecting.
      if nargin < 2
        filter = struct();
      end
      sub = RobotRaconteurServiceInfo2Subscription(rrmex('subscribe_info', types, filter));
    end

    function found = FindServiceByType(type, schemes, seconds)
      %FINDSERVICEBYTYPE Services of a type, as a struct array. Nodes are asked and waited for.
      if nargin < 2
        schemes = {};
      end
      if nargin < 3
        seconds = 1;
      end
      found = rrmex('find_type', type, schemes, seconds);
    end
    function found = FindNodeByID(id, schemes, seconds)
      %FINDNODEBYID The node of an id, as a struct array of none or one. schemes ({} for all)
      %   leaves out other URLs; nodes are asked and waited for seconds (1).
      if nargin < 2
        schemes = {};
      end
      if nargin < 3
        seconds = 1;
      end
      found = rrmex('find_node_id', id, schemes, seconds);
    end
    function found = FindNodeByName(name, schemes, seconds)
      %FINDNODEBYNAME All nodes of a name, as a struct array. schemes ({} for all) leaves out
      %   other URLs; nodes are asked and waited for seconds (1).
      if nargin < 2
        schemes = {};
      end
      if nargin < 3
        seconds = 1;
      end
      found = rrmex('find_node_name', name, schemes, seconds);
    end
    function UpdateDetectedNodes(schemes, seconds)
      %UPDATEDETECTEDNODES Ask all nodes to announce themselves, and wait.
      if nargin < 2
        seconds = 1;
      end
      rrmex('update_nodes', seconds);
    end
    function found = GetDetectedNodes()
      %GETDETECTEDNODES Nodes that are known, as a struct array.
      found = rrmex('detected_nodes');
    end

    function RegisterServiceType(definition)
      %REGISTERSERVICETYPE Make a definition known that services are offered by: its text, or the
      %   name of a file. Those that it imports, too, before the first object is served.
      rrmex('service_type', rr_definition_text(definition));
    end
    function service = RegisterService(name, type, obj, options)
      %REGISTERSERVICE service = RobotRaconteur.RegisterService(name, type, obj, options)
      %   Offers obj, a handle object or a struct of function handles (see RobotRaconteurServed), as
      %   an object of a registered type. options is a struct: Attributes (a containers.Map or
      %   struct), Users (a text of users), RequireUser (false: clients may also come without a
      %   user), Rights (a text of rules, what each user may do) or RightsFile (a file of them, which
      %   is looked at every second), ExtraImports (cells with the names of the definitions that clients get besides
      %   those that the type's imports; without it they get all that are known). Requests are
      %   answered by Poll and ServeFor, and while a call of one's own waits.
      if nargin < 4
        options = struct();
      end
      if ~isa(obj, 'RobotRaconteurServed')
        obj = RobotRaconteurServed(type, obj);
      end
      service = RobotRaconteurService(name, obj, options);
    end
    function port = StartServer(port, address)
      %STARTSERVER Listen at a TCP port, 0 for a free one; returns it. Clients of this machine can
      %   connect; with '*' as address those of others, too.
      if nargin < 1
        port = 0;
      end
      if nargin < 2
        address = '';
      end
      port = rrmex('listen_tcp', port, address);
    end
    function Listen(url)
      %LISTEN Listen by another channel, as Listen('rr+local:///path'); see docs/howto/channels.md.
      rrmex('listen_url', url);
    end
    function count = ServeFor(seconds)
      %SERVEFOR Answer requests, and call handlers, for so long; returns how many requests, and
      %   values and packets that an object was told. Ctrl-C ends it.
      count = rrmex('serve_for', seconds);
    end
    function number = CurrentClient()
      %CURRENTCLIENT Whose request is answered now, for CallBack; 0 for nobody's.
      number = rrmex('current_client');
    end

    function varargout = ThrowError(err)
      %THROWERROR Throw an error that a service's client, or a callback's service, gets as it is,
      %   with what an identifier cannot say: a struct like that of GetLastError, of which name or
      %   code is enough. ThrowError(struct('name', 'example.arm.Jam', 'message', 'stuck', ...
      %   'subname', 'joint', 'parameter', RobotRaconteurVarValue(3, 'int32'))). It gives nothing,
      %   but may stand where a result is expected: @(a, b) RobotRaconteur.ThrowError(...).
      varargout = {};
      rrmex('throw', err);
    end
    function SetNodeOptions(options)
      %SETNODEOPTIONS How the node is made: before it is used first, or after Shutdown. A struct
      %   with any of NodeName, NodeID; RequestTimeout, ConnectTimeout, HeartbeatPeriod in seconds;
      %   MemoryTransferLimit, ClientSessionLimit in bytes; CertificateFile, KeyFile, AuthorityFiles
      %   and RevocationFiles (cells), Pins (a containers.Map of node ids and SHA-256), RequireTls,
      %   MustCertifyClients, TrustSystemAuthorities, AcceptsOutdatedLists, LookAgainPeriod;
      %   AuditFile (lines of JSON: who connects, logs in, is refused), AuditRequests (handled
      %   requests, too); SharedMemory (messages and wires of rr+local go through memory where the
      %   other node has it, too), Spin (seconds, up to 0.001, that a waiting thread looks for a
      %   message before it sleeps, with SharedMemory); AllowClearCredentials (log in without TLS
      %   where discovery has found a URL);
      %   ClientOffer and ServerOffer: structs with any of MessageV4, StringTable, CombinedConnect.
      rrmex('node_options', options);
    end
    function SetLogLevel(level)
      %SETLOGLEVEL 'DEBUG', 'INFO', 'WARNING', 'ERROR', 'DISABLE'
      rrmex('log_level', level);
    end
    function OpenLogFile(path)
      %OPENLOGFILE Write the log to a file, too, until CloseLogFile.
      rrmex('log_open', path);
    end
    function CloseLogFile()
      %CLOSELOGFILE Write the log to no file any more.
      rrmex('log_close');
    end
    function time = nowUTC()
      %NOWUTC The time, as wires have it: struct with seconds since 1970 and nanoseconds.
      time = rrmex('now');
    end
    function Sleep(seconds)
      %SLEEP Wait; callbacks of services run meanwhile.
      rrmex('sleep', seconds);
    end
    function setRequestTimeout(seconds)
      %SETREQUESTTIMEOUT How long calls wait for their answers, 15 at first.
      rrmex('request_timeout', seconds);
    end
    function found = GetLastError()
      %GETLASTERROR What the last error of a call had: code, name, subname, message, identifier,
      %   and the parameter that the service has sent with it: as plain data in `parameter`, and
      %   with its type, as a RobotRaconteurVarValue, in `varvalue`; [] for none.
      found = rrmex('last_error');
    end
    function name = ErrorName(err)
      %ERRORNAME The full name of a caught error: 'experimental.arm.Jam' of experimental:arm:Jam.
      %   '' for an error that is not one of Robot Raconteur's. An identifier has other characters
      %   than a name: see docs/howto/matlab.md, Errors.
      name = rrmex('error_name', err.identifier);
    end
    function Shutdown()
      %SHUTDOWN End all connections and the node. What is used next starts another one.
      rr_prompt(false);
      rrmex('shutdown');
    end
  end
end
