classdef ConformanceClient < ConformanceStreams
  %CONFORMANCECLIENT The role `call`: does the steps of a plan as a user of the toolbox would.
  properties (Constant)
    Patience = 0.005;
  end
  properties
    IsStarted = false;
    UsesAsync = false;  % for calls and properties: in plans of version 2
    Objects   % by the plan's names: struct with object, members
    Calls     % of callbacks, how many
  end
  methods
    function Work(obj)
      if obj.IsStarted
        RobotRaconteur.Poll(0);
      end
    end

    function answer = Answer(obj, request)
      switch request.do
        case 'start'
          RobotRaconteur.Shutdown();
          RobotRaconteur.SetNodeOptions(conformance_node_options(request));
          obj.UsesAsync = request.message_version == 2;
          for name = {'Objects', 'Handles', 'Types', 'Closing', 'Calls'}
            obj.(name{1}) = containers.Map();
          end
          obj.Arrived = cell(0, 1);
          obj.IsStarted = true;
          answer = struct('done', true);
        case 'stop_node'
          RobotRaconteur.Shutdown();
          obj.IsStarted = false;
          answer = struct('done', true);
        case 'step'
          answer = struct();
          try
            answer.result = obj.Play(request.step);
          catch err
            answer.raised = conformance_raised(err);
          end
      end
    end

    function result = Play(obj, step)
      result = [];
      switch step.op
        case 'connect'
          result = obj.Connect(step);
        case 'disconnect'
          RobotRaconteur.DisconnectService(obj.Object(step));
        case 'get'
          [target, member] = obj.Find(step);
          if obj.UsesAsync
            value = conformance_await(@(done) target.(['async_get_', step.member])(done));
          else
            value = target.(step.member);
          end
          result = conformance_mex('json', member.type, value);
        case 'set'
          [target, member] = obj.Find(step);
          value = conformance_mex('value', member.type, step.value);
          if obj.UsesAsync
            conformance_await(@(done) target.(['async_set_', step.member])(value, done));
          else
            target.(step.member) = value;
          end
        case 'call'
          result = obj.Call(step);
        case 'objref'
          result = obj.Follow(step);
        case 'find_object_type'
          result = RobotRaconteur.FindObjectType(obj.Object(step), step.member, index_of(step){:});
        case 'listen'
          [target, member] = obj.Find(step);
          name = step.member;
          if isfield(step, 'as')
            name = step.as;
          end
          addlistener(target, step.member, @(varargin) obj.Arrive('event', name, 'args', ...
            conformance_list(member.parameters, varargin)));
        case 'attributes'
          [~, found] = RobotRaconteur.GetServiceAttributes(obj.Object(step));
          result = struct();
          for name = found.keys()
            result.(name{1}) = conformance_mex('json', 'varvalue', found(name{1}));
          end
        case 'local_services'
          result = local_services(obj.Object(step).GetLocalNodeServices());
        case 'callback_set'
          [target, member] = obj.Find(step);
          obj.Calls(step.member) = 0;
          target.(step.member) = @(varargin) obj.CalledBack(step, member, varargin);
        case 'wait'
          result = obj.Wait(step.count);
        case 'drain'
          RobotRaconteur.Poll(0);
          obj.Arrived = cell(0, 1);
        case 'sleep'
          RobotRaconteur.Sleep(step.ms / 1000);
        otherwise
          kind = strtok(step.op, '_');
          switch kind
            case 'pipe'
              result = obj.PlayPipe(step);
            case 'wire'
              result = obj.PlayWire(step);
            case 'mem'
              result = obj.PlayMemory(step);
            case 'gen'
              result = obj.PlayGenerator(step);
            otherwise
              result = obj.PlaySession(step);
          end
      end
    end

    function result = PlaySession(obj, step)
      result = [];
      target = obj.Object(step);
      switch step.op
        case 'authenticate'
          RobotRaconteur.Authenticate(target, step.username, credentials_of(step));
          result = 'OK';
        case 'lock'
          kind = 'User';
          if isfield(step, 'client') && step.client
            kind = 'Client';
          end
          RobotRaconteur.RequestObjectLock(target, kind);
          result = 'OK';
        case 'unlock'
          RobotRaconteur.ReleaseObjectLock(target);
          result = 'OK';
        case 'monitor_enter'
          RobotRaconteur.MonitorEnter(target, step.timeout / 1000);
        case 'monitor_exit'
          RobotRaconteur.MonitorExit(target);
        otherwise
          error('this runner cannot do %s', step.op);
      end
    end

    function target = Object(obj, step)
      target = obj.Objects(step.obj).object;
    end

    function [target, member] = Find(obj, step)
      known = obj.Objects(step.obj);
      target = known.object;
      member = known.members.(step.member);
    end

    function result = Keep(obj, name, object, type)
      members = struct();
      if ~strncmp(type, 'RobotRaconteurServiceIndex.', 27)
        members = conformance_mex('members', type);
      end
      obj.Objects(name) = struct('object', object, 'members', members);
      result = struct('rrtype', type);
    end

    function result = Connect(obj, step)
      username = '';
      type_name = '';
      if isfield(step, 'username')
        username = step.username;
      end
      if isfield(step, 'objecttype')
        type_name = step.objecttype;
      end
      root = RobotRaconteur.ConnectService(step.url, username, credentials_of(step), type_name);
      RobotRaconteur.AddClientServiceListener(root, @(what, detail) obj.Told(step.as, what, detail));
      result = obj.Keep(step.as, root, type(root));
    end

    function Told(obj, service, what, detail)
      if strcmp(what, 'ClientClosed')
        obj.Arrive('event_type', 1, 'service', service);
      else
        obj.Arrive('event_type', 5, 'path', detail, 'service', service);
      end
    end

    function result = Follow(obj, step)
      [target, member] = obj.Find(step);
      index = index_of(step);
      found = target.(['get_', step.member])(index{:});
      % A varobject has no declared type: it is what the service says.
      declared = member.object_type;
      if isempty(declared)
        declared = type(found);
      end
      result = obj.Keep(step.as, found, declared);
    end

    function result = Call(obj, step)
      [target, member] = obj.Find(step);
      given = conformance_values(member.parameters, step.args);
      result = [];
      if obj.UsesAsync
        value = conformance_await(@(done) target.(['async_', step.member])(given{:}, done));
      elseif isempty(member.type)
        target.(step.member)(given{:});
      else
        value = target.(step.member)(given{:});
      end
      if ~isempty(member.type)
        result = conformance_mex('json', member.type, value);
      end
    end

    function result = CalledBack(obj, step, member, given)
      args = conformance_list(member.parameters, given);
      obj.Arrive('callback', step.member, 'args', args);
      obj.Calls(step.member) = obj.Calls(step.member) + 1;
      outcome = conformance_outcome(step.outcomes, obj.Calls(step.member));
      if isfield(outcome, 'throw')
        conformance_raise(outcome.throw, args);
      end
      result = [];
      if ~isempty(member.type)
        result = conformance_mex('value', member.type, outcome.return);
      end
    end

    function things = Wait(obj, count)
      begun = tic();
      RobotRaconteur.Poll(0);
      while numel(obj.Arrived) < count && toc(begun) < 2
        RobotRaconteur.Poll(2 - toc(begun));
      end
      things = obj.Arrived;
      obj.Arrived = cell(0, 1);
    end
  end
end

function index = index_of(step)
index = {};
if isfield(step, 'index')
  index = {step.index};
end
end

function given = credentials_of(step)
given = struct();
if isfield(step, 'credentials')
  given = structfun(@(value) conformance_mex('value', 'varvalue', value), step.credentials, ...
                    'UniformOutput', false);
end
end

function result = local_services(found)
result = cell(0, 1);
for key = found.keys()
  info = found(key{1});
  result{end + 1, 1} = struct('index', double(key{1}), 'name', info.Name, 'type', info.RootObjectType);
end
end
