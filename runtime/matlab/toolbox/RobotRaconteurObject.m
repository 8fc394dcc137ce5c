classdef RobotRaconteurObject < handle
  %ROBOTRACONTEUROBJECT An object of a service, with the members that the service says it has.
  %   value = obj.property;  obj.property = value;
  %   result = obj.function_name(arguments);  obj.function_name
  %   other = obj.get_objref(index);
  %   wire = obj.wire.Connect();  pipe = obj.pipe.Connect(-1);  m = obj.memory;
  %   obj.callback = @f;  l = addlistener(obj, 'event', @f);
  %   obj.async_function_name(arguments, @handler, parameter, seconds)
  %   methods(obj) lists the members. See also RobotRaconteur.
  properties (Hidden)
    rr_h = uint64(0);
  end
  methods
    function obj = RobotRaconteurObject(number)
      obj.rr_h = number;
    end

    function varargout = subsref(obj, s)
      if ~strcmp(s(1).type, '.')
        error('RobotRaconteur:InvalidOperation', 'an object of a service has no index');
      end
      name = s(1).subs;
      if strncmp(name, 'rr_', 3)
        [varargout{1:nargout}] = builtin('subsref', obj, s);
        return
      end
      called = numel(s) > 1 && strcmp(s(2).type, '()');
      given = {};
      if called
        given = s(2).subs;
      end
      if strncmp(name, 'async_', 6)
        rr_start(obj, name(7:end), given);
        varargout = {};
        return
      end
      if any(strcmp(name, {'delete', 'disp', 'isvalid', 'addlistener'}))
        [varargout{1:nargout}] = feval(name, obj, given{:});
        return
      end
      [value, kind] = rrmex('access', obj.rr_h, name, called, given{:});
      used = 1;
      switch kind
        case 1
          used = 1 + called;
        case 2
          varargout = {};
          return
        case {3, 4}
          value = rr_wrap(obj, value, kind);
          used = 1 + called;
        otherwise
          value = rr_wrap(obj, value, kind);
      end
      if numel(s) > used
        if called && used == 1 && isempty(given)
          used = 2;
        end
      end
      if numel(s) > used
        rest = s(used + 1:end);
        count = max(nargout, 1);
        if nargout == 0 && rr_is_void(rest)
          count = 0;
        end
        [varargout{1:count}] = subsref(value, rest);
      else
        varargout = {value};
      end
    end

    function obj = subsasgn(obj, s, value)
      if ~strcmp(s(1).type, '.')
        error('RobotRaconteur:InvalidOperation', 'an object of a service has no index');
      end
      name = s(1).subs;
      if strncmp(name, 'rr_', 3)
        obj = builtin('subsasgn', obj, s, value);
        return
      end
      if numel(s) > 1
        part = subsref(obj, s(1));
        value = subsasgn(part, s(2:end), value);
        if isa(part, 'RobotRaconteurMemory') || isa(part, 'RobotRaconteurWire')
          return
        end
      end
      rrmex('assign', obj.rr_h, name, value);
    end

    function listener = addlistener(obj, event, handler)
      %ADDLISTENER Call handler(parameters...) for each event; delete(listener) ends it.
      listener = RobotRaconteurListener(rrmex('listen', obj.rr_h, event, handler));
    end

    function delete(obj)
      if obj.rr_h ~= 0
        rrmex('close', obj.rr_h);
        obj.rr_h = uint64(0);
      end
    end

    function answer = eq(a, b)
      answer = isa(a, 'RobotRaconteurObject') && isa(b, 'RobotRaconteurObject') && ...
               rrmex('same', a.rr_h, b.rr_h);
    end

    function answer = ne(a, b)
      answer = ~(a == b);
    end

    function answer = numel(obj, varargin)
      answer = 1;
    end

    function answer = numArgumentsFromSubscript(obj, s, context)
      answer = 1;
    end

    function names = properties(obj)
      %PROPERTIES Names of the properties, wires, pipes, memories and callbacks.
      [names, declarations] = rrmex('members', obj.rr_h);
      names = names(cellfun(@isempty, regexp(declarations, '^(function|objref|event)')));
      if nargout == 0
        fprintf('  %s\n', names{:});
        clear names
      end
    end

    function found = methods(obj)
      %METHODS The members as their definition declares them; with a result, how they are called.
      [names, declarations] = rrmex('members', obj.rr_h);
      if nargout == 0
        fprintf('Members of %s:\n', rrmex('about', obj.rr_h).type);
        fprintf('  %s\n', declarations{:});
        return
      end
      found = {};
      for i = 1:numel(names)
        kind = strtok(declarations{i});
        if strcmp(kind, 'function')
          found{end + 1, 1} = names{i};
        elseif strcmp(kind, 'objref')
          found{end + 1, 1} = ['get_', names{i}];
        end
      end
    end

    function answer = ismethod(obj, name)
      answer = any(strcmp(name, methods(obj)));
    end

    function answer = isprop(obj, name)
      answer = any(strcmp(name, properties(obj)));
    end

    function names = fieldnames(obj)
      names = properties(obj);
    end

    function text = type(obj)
      %TYPE The type of the object, in full.
      text = rrmex('about', obj.rr_h).type;
    end

    function text = members(obj)
      %MEMBERS The declarations of the members, one in each cell.
      [names, text] = rrmex('members', obj.rr_h);
    end

    function text = servicedef(obj)
      %SERVICEDEF The definition in which the object is declared, as the service has sent it.
      name = rrmex('about', obj.rr_h).type;
      text = rrmex('definition', obj.rr_h, name(1:find(name == '.', 1, 'last') - 1));
    end

    function disp(obj)
      rr_show(obj);
    end

    function display(obj)
      fprintf('%s =\n\n', inputname(1));
      disp(obj);
      fprintf('\n');
    end
  end
  methods (Access = private)
    function rr_start(obj, name, given)
      count = rrmex('parameter_count', obj.rr_h, name);
      handler = [];
      parameter = [];
      seconds = -1;
      if numel(given) > count
        handler = given{count + 1};
      end
      if numel(given) > count + 1
        parameter = given{count + 2};
      end
      if numel(given) > count + 2
        seconds = given{count + 3};
      end
      if numel(given) > count + 3
        error('RobotRaconteur:InvalidArgument', ...
              'async_%s: expected %d arguments, then handler, parameter, seconds', name, count);
      end
      rrmex('async', obj.rr_h, name, handler, parameter, seconds, ...
            given{1:min(count, numel(given))});
    end
  end
end

function answer = rr_is_void(s)
% Methods that give nothing, so that nothing is asked of them.
answer = strcmp(s(1).type, '.') && any(strcmp(s(1).subs, ...
  {'PokeOutValue', 'Close', 'Abort', 'async_Next', 'SetQueueLimit', 'delete', 'disp'}));
end
