classdef ConformanceScript < handle
  %CONFORMANCESCRIPT An object that does what a node of service.json says: functions of the interpreter, as
  %   RobotRaconteurServed takes them. Functions of the object that drive its other members are known by
  %   their names: fire_EVENT, send_PIPE, close_PIPE, received_count, send_WIRE, close_WIRE, last_WIRE,
  %   call_CALLBACK, release_child; with `_later` behind it a function does so when it has been answered.
  %   An outcome with `does` gives such a name to any function.
  properties
    Node
    Home
    Members
    Served
    Calls
    Children
    Received = 0;
  end
  methods
    function obj = ConformanceScript(type, node, home)
      obj.Node = node;
      obj.Home = home;
      obj.Members = conformance_mex('members', type);
      obj.Calls = containers.Map();
      obj.Children = containers.Map();
      served = struct();
      has_monitor = false;
      for name = fieldnames(obj.Members)'
        member = obj.Members.(name{1});
        served = obj.Add(served, name{1}, member);
        has_monitor = has_monitor || member.is_free;
      end
      obj.Served = RobotRaconteurServed(type, served);
      if has_monitor
        obj.Served.EnableMonitor();
      end
    end

    function served = Add(obj, served, name, member)
      switch member.kind
        case 'property'
          served.(name) = @() obj.Get(name, member.type);
          served.(['set_', name]) = @(value) obj.Set(name, member.type, value);
        case 'function'
          if member.is_generator
            served.(name) = @(varargin) obj.Generate(name, member, varargin);
          else
            served.(name) = @(varargin) obj.Call(name, member, varargin);
          end
        case 'objref'
          served.(name) = @(varargin) obj.Child(name, varargin{:});
        case 'pipe'
          served.(['on_', name]) = @(packet, client) obj.Count();
        case 'wire'
          told = obj.Told('wires', name);
          served.(['peek_in_', name]) = @() obj.Peek(name, member.type, 'peek_in');
          served.(['peek_out_', name]) = @() obj.PeekOut(name, member.type);
          if isfield(told, 'at_connect') && isequal(told.at_connect, true)
            served.(['connected_', name]) = @(client) obj.Home.Player.DoLater( ...
              @() obj.Served.SetInValue(name, obj.Peek(name, member.type, 'peek_in')));
          end
        case 'memory'
          content = obj.Told('memories', name);
          if iscell(content) || isstruct(content)
            served.(name) = conformance_mex('value', member.type, content);
          end
      end
    end

    function entry = Told(obj, kind, name)
      %TOLD What the script says about a member; [] for nothing.
      entry = [];
      if isfield(obj.Node, kind) && isfield(obj.Node.(kind), name)
        entry = obj.Node.(kind).(name);
      end
    end

    function value = Get(obj, name, type)
      entry = obj.Told('properties', name);
      json = [];
      if isfield(entry, 'get_throw')
        conformance_raise(entry.get_throw, {});
      elseif isfield(entry, 'value')
        json = entry.value;
      end
      value = conformance_mex('value', type, json);
    end

    function Set(obj, name, type, value)
      entry = obj.Told('properties', name);
      if isfield(entry, 'set_throw')
        conformance_raise(entry.set_throw, {});
      end
      obj.Node.properties.(name).value = conformance_mex('json', type, value);
    end

    function value = Call(obj, name, member, given)
      value = [];
      json = obj.Outcome(name, member, conformance_list(member.parameters, given));
      if ~isempty(member.type)
        value = conformance_mex('value', member.type, json);
      end
    end

    function json = Outcome(obj, name, member, args)
      is_done = false;
      json = [];
      if ~obj.SaysWhatItDoes(name)
        [is_done, json] = obj.Do(name, member, args);
      end
      if is_done
        return
      end
      outcome = obj.Next(name, args);
      if isfield(outcome, 'does') && ischar(outcome.does)
        [is_done, json] = obj.Do(outcome.does, member, args);
        if ~is_done
          error('RobotRaconteur:InvalidArgument', 'nothing is called %s', outcome.does);
        end
      elseif isfield(outcome, 'echo')
        json = args{outcome.echo + 1};
      elseif isfield(outcome, 'return')
        json = outcome.return;
      end
    end

    function says = SaysWhatItDoes(obj, name)
      %SAYSWHATITDOES Whether an outcome says what the function does, whatever its name says.
      outcomes = obj.Told('functions', name);
      if ~iscell(outcomes)
        outcomes = {outcomes};
      end
      says = any(cellfun(@(outcome) isfield(outcome, 'does'), outcomes));
    end

    function [is_done, json] = Do(obj, name, member, args)
      %DO Does what a function of this name is for; false for a name that says nothing.
      is_done = true;
      json = [];
      if strcmp(name, 'release_child')
        obj.Home.Release(args{1});
        return
      end
      [action, on] = obj.Action(name);
      if ~isempty(action)
        json = obj.Act(action, on, member.type);
        return
      end
      [action, on] = obj.Action(regexprep(name, '_later$', ''));
      is_done = ~isempty(action);
      if is_done
        obj.Home.Player.DoLater(@() obj.ActBehind(action, on));
      end
    end

    function ActBehind(obj, action, on)
      %ACTBEHIND Acts when the call that asked for it has been answered, and tells of it where that is asked for.
      obj.Act(action, on, '');
      told = ['answered_', on];
      if isfield(obj.Members, told) && strcmp(obj.Members.(told).kind, 'event')
        obj.Act('fire', told, '');
      end
    end

    function outcome = Next(obj, name, args)
      %NEXT The outcome of the next call of a function; throws what it says.
      if ~isKey(obj.Calls, name)
        obj.Calls(name) = 0;
      end
      obj.Calls(name) = obj.Calls(name) + 1;
      outcome = conformance_outcome(obj.Told('functions', name), obj.Calls(name));
      if isfield(outcome, 'throw')
        conformance_raise(outcome.throw, args);
      end
    end

    function steps = Generate(obj, name, member, given)
      told = obj.Next(name, conformance_list(member.parameters, given));
      state = ConformanceSteps(told, member.type);
      steps = struct('next', @(value) state.Next());
    end

    function [action, on] = Action(obj, name)
      %ACTION What a function does with another member; '' for none.
      on = '';
      action = '';
      kinds = struct('fire', {{'event'}}, 'send', {{'pipe', 'wire'}}, 'close', {{'pipe', 'wire'}}, ...
                     'last', {{'wire'}}, 'call', {{'callback'}});
      [verb, rest] = strtok(name, '_');
      rest = rest(2:end);
      if strcmp(name, 'received_count')
        action = name;
      elseif isfield(kinds, verb) && isfield(obj.Members, rest) && ...
             any(strcmp(obj.Members.(rest).kind, kinds.(verb)))
        action = verb;
        on = rest;
      end
    end

    function json = Act(obj, action, on, result_type)
      json = [];
      if strcmp(action, 'received_count')
        json = obj.Received;
        return
      end
      member = obj.Members.(on);
      switch [action, ' ', member.kind]
        case 'fire event'
          for arguments = obj.Told('events', on)'
            values = conformance_values(member.parameters, arguments{1});
            obj.Served.Fire(on, values{:});
          end
        case 'send pipe'
          for endpoint = obj.Served.Endpoints(on)'
            for entry = obj.Told('pipes', on)'
              wants_ack = isfield(entry{1}, 'ack') && entry{1}.ack;
              packet = conformance_mex('value', member.type, entry{1}.packet);
              obj.Served.SendPacketTo(on, endpoint, packet, wants_ack);
            end
          end
        case 'send wire'
          for value = obj.Told('wires', on).send'
            obj.Served.SetInValue(on, conformance_mex('value', member.type, value{1}));
          end
        case {'close pipe', 'close wire'}
          obj.Served.Disconnect(on);
        case 'last wire'
          [value, time] = obj.Served.OutValue(on);
          if isempty(time)
            error('RobotRaconteur:ValueNotSet', 'Value not set');
          end
          json = conformance_mex('json', member.type, value);
        case 'call callback'
          json = obj.CallBack(on, member, result_type);
      end
    end

    function json = CallBack(obj, name, member, result_type)
      % A function of another type tells the error as a text.
      json = [];
      given = conformance_values(member.parameters, obj.Told('callbacks', name));
      try
        value = obj.Served.CallBack(name, RobotRaconteur.CurrentClient(), given{:});
      catch err
        if strcmp(result_type, member.type)
          rethrow(err);
        end
        json = [RobotRaconteur.GetLastError().name, ': ', err.message];
        return
      end
      if ~isempty(member.type)
        json = conformance_mex('json', member.type, value);
      end
    end

    function value = Peek(obj, name, type, key)
      told = obj.Told('wires', name);
      if ~isfield(told, key)
        error('RobotRaconteur:ValueNotSet', 'Value not set');
      end
      value = conformance_mex('value', type, told.(key));
    end

    function value = PeekOut(obj, name, type)
      [value, time] = obj.Served.OutValue(name);
      if isempty(time)
        value = obj.Peek(name, type, 'peek_out');
      end
    end

    function Count(obj)
      obj.Received = obj.Received + 1;
    end

    function found = Child(obj, name, index)
      %CHILD The object that an objref gives; the same one each time.
      text = '';
      if nargin > 2
        text = index;
        if isnumeric(index)
          text = sprintf('%d', index);
        end
      end
      key = [name, '[', text, ']'];
      if isKey(obj.Children, key)
        found = obj.Children(key).Served;
        return
      end
      found = [];
      entry = obj.Told('objrefs', name);
      if ~isstruct(entry)
        return
      end
      if nargin > 2
        if ~isfield(entry, 'items') || ~isfield(entry.items, text)
          error('RobotRaconteur:InvalidArgument', 'no object with index %s', text);
        end
        entry = entry.items.(text);
      end
      obj.Children(key) = ConformanceScript(entry.type, entry.node, obj.Home);
      found = obj.Children(key).Served;
    end
  end
end
