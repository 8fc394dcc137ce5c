classdef RobotRaconteurStub < RobotRaconteurHandle
  %ROBOTRACONTEURSTUB An object of a service, whatever is known of its members.
  %   The base of RobotRaconteurObject and of the classes that robdef generates for the objects of
  %   a definition. These are used in its place wherever one is taken, but their members are
  %   listed in the class, with help, and faster.
  methods
    function obj = RobotRaconteurStub(type, names, varargin)
      if nargin == 0
        return  % the number is known already
      end
      if isempty(varargin)
        error('RobotRaconteur:InvalidArgument', 'expected a URL, or an object');
      end
      other = varargin{1};
      if ~isa(other, 'RobotRaconteurStub')
        other = RobotRaconteur.ConnectService(varargin{:});
      end
      obj.rr_h = rrmex('typed', other, type, names);
    end

    function answer = eq(a, b)
      %EQ Whether both are the same object of the same session.
      answer = isa(a, 'RobotRaconteurStub') && isa(b, 'RobotRaconteurStub') && ...
               rrmex('same', a, b);
    end

    function answer = ne(a, b)
      %NE Whether they are different objects.
      answer = ~(a == b);
    end

    function listener = addlistener(obj, event, handler)
      %ADDLISTENER Call handler(parameters...) for each event; delete(listener) ends it.
      listener = RobotRaconteurListener(rrmex('listen', obj, event, handler));
    end

    function answer = ismethod(obj, name)
      %ISMETHOD Whether it has a method of this name.
      answer = any(strcmp(name, methods(obj)));
    end

    function answer = isprop(obj, name)
      %ISPROP Whether it has a property of this name.
      answer = any(strcmp(name, properties(obj)));
    end

    function text = type(obj)
      %TYPE The type of the object, in full; it may be one that implements the class's.
      text = rrmex('about', obj).type;
    end

    function text = members(obj)
      %MEMBERS The declarations of the members, one in each cell.
      [names, text] = rrmex('members', obj);
    end

    function text = servicedef(obj)
      %SERVICEDEF The definition in which the object is declared, as the service has sent it.
      name = rrmex('about', obj).type;
      text = rrmex('definition', obj, name(1:find(name == '.', 1, 'last') - 1));
    end

    function disp(obj)
      rr_show(obj);
    end

    function value = rr_access(obj, name, varargin)
      [value, kind] = rrmex('access', obj, name, varargin{:});
      value = rr_wrap(obj, value, kind);
    end

    function rr_assign(obj, name, value)
      rrmex('assign', obj, name, value);
    end

    function rr_written(obj, name, value)
      % The part of a memory has been written when the memory itself comes back.
      if ~isa(value, 'RobotRaconteurMemory')
        rrmex('assign', obj, name, value);
      end
    end

    function rr_async(obj, name, given, handler, more)
      rrmex('async', obj, name(7:end), given{:}, handler, more{:});
    end
  end

  methods (Static)
    function value = rr_record(name, definitions, given)
      if ~rrmex('record_known', name)
        rrmex('record_define', name, unique(definitions()));
      end
      if numel(given) == 1
        value = rrmex('record', name, given{1});
        return
      end
      value = rrmex('record', name);
      if ~isstruct(value) && ~isempty(given)
        % A namedarray: numbers in a column, which can be given by their names, all of them.
        value = rrmex('record', name, struct(given{:}));
        return
      end
      if mod(numel(given), 2) ~= 0
        error('RobotRaconteur:InvalidArgument', '%s: expected names and values', name);
      end
      for i = 1:2:numel(given)
        if ~isfield(value, given{i})
          error('RobotRaconteur:InvalidArgument', '%s has no field `%s`', name, given{i});
        end
        value.(given{i}) = given{i + 1};
      end
      if ~isempty(given)
        value = rrmex('record', name, value);
      end
    end
  end
end
