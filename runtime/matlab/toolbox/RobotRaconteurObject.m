classdef RobotRaconteurObject < RobotRaconteurStub
  %ROBOTRACONTEUROBJECT An object of a service, with the members that the service says it has.
  %   value = obj.property;  obj.property = value;
  %   result = obj.function_name(arguments);  obj.function_name
  %   other = obj.get_objref(index);
  %   wire = obj.wire.Connect();  pipe = obj.pipe.Connect(-1);  m = obj.memory;
  %   obj.callback = @f;  l = addlistener(obj, 'event', @f);
  %   obj.async_function_name(arguments, @handler, parameter, seconds)
  %   methods(obj) lists the members. See also RobotRaconteur.
  methods
    function obj = RobotRaconteurObject(number)
      obj.rr_h = number;
    end

    function varargout = subsref(obj, s)
      % Each line here takes the interpreter longer than the MEX file needs for all of it.
      [value, left] = rrmex('subsref', obj, s.subs);
      if left
        varargout = rr_go_on(obj, s, nargout, value, left);
      else
        varargout = {value};
      end
    end

    function obj = subsasgn(obj, s, value)
      left = rrmex('subsasgn', obj, value, s.subs);
      if left
        obj = rr_assign_rest(obj, s, value, left);
      end
    end

    function answer = numel(obj, varargin)
      answer = 1;
    end

    function count = numArgumentsFromSubscript(obj, s, context)
      % MATLAB asks for so many results of subsref; Octave does not call this.
      count = 1;
      if strcmp(char(context), 'Assignment')
        return
      end
      count = rrmex('result_count', obj, s.subs);
      if count < 0
        count = double(~strcmp(char(context), 'Statement'));
      end
    end

    function names = properties(obj)
      %PROPERTIES Names of the properties, wires, pipes, memories and callbacks.
      [names, declarations] = rrmex('members', obj);
      names = names(cellfun(@isempty, regexp(declarations, '^(function|objref|event)')));
      if nargout == 0
        fprintf('  %s\n', names{:});
        clear names
      end
    end

    function found = methods(obj)
      %METHODS The members as their definition declares them; with a result, how they are called.
      [names, declarations] = rrmex('members', obj);
      if nargout == 0
        fprintf('Members of %s:\n', rrmex('about', obj).type);
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

    function names = fieldnames(obj)
      %FIELDNAMES Names of its properties and other members, as properties(obj).
      names = properties(obj);
    end

    function display(obj)
      fprintf('%s =\n\n', inputname(1));
      disp(obj);
      fprintf('\n');
    end
  end
  methods (Access = private)
    function results = rr_go_on(obj, s, count, value, left)
      % What the MEX file leaves to do, by the number that it gives: see commands_dotted.cpp.
      results = {};
      switch left(1)
        case 2
          return
        case 8
          [results{1:count}] = builtin('subsref', obj, s);
          return
        case 9
          given = {};
          if left(2) == 2
            given = s(2).subs;
          end
          [results{1:count}] = feval(s(1).subs, obj, given{:});
          return
      end
      value = rr_wrap(obj, value, left(1));
      rest = s(left(2) + 1:end);
      if isempty(rest)
        results = {value};
        return
      end
      if count == 0
        count = rr_result_count(value, rest);
      end
      [results{1:count}] = subsref(value, rest);
    end

    function obj = rr_assign_rest(obj, s, value, left)
      if left == 8
        obj = builtin('subsasgn', obj, s, value);
        return
      end
      part = subsref(obj, s(1));
      value = subsasgn(part, s(2:end), value);
      if ~isa(part, 'RobotRaconteurMemory') && ~isa(part, 'RobotRaconteurWire')
        rrmex('assign', obj, s(1).subs, value);
      end
    end
  end
end
