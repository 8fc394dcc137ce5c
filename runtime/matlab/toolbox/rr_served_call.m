function result = rr_served_call(served, kind, name, varargin)
%RR_SERVED_CALL Answer one request of a client with an object that is served.
switch kind
  case 'get'
    need(served, name);
    result = served.(name);
    if isa(result, 'function_handle')
      result = result();
    end
  case 'set'
    result = [];
    if rr_served_has(served, ['set_', name])
      call(served, ['set_', name], false, varargin);
    elseif isstruct(served)
      error('RobotRaconteur:NotImplementedError', '%s cannot be set', name);
    else
      need(served, name);
      served.(name) = varargin{1};
    end
  case 'call'
    need(served, name);
    result = call(served, name, true, varargin);
  case 'do'
    need(served, name);
    result = call(served, name, false, varargin);
  case 'generate'
    need(served, name);
    generator = RobotRaconteurSteps(call(served, name, true, varargin));
    result = @(action, value) generator.Step(action, value);
  case 'objref'
    result = find_object(served, name, varargin{1}, varargin(2:end));
  case {'on', 'connected'}
    result = [];
    call(served, [kind, '_', name], false, varargin);
  case {'peek_in', 'peek_out'}
    result = call(served, [kind, '_', name], true, {});
end
end

function need(served, name)
if ~rr_served_has(served, name)
  error('RobotRaconteur:NotImplementedError', '%s is not implemented by this object', name);
end
end

function result = call(served, name, has_result, given)
result = [];
if isstruct(served)
  f = served.(name);
else
  f = @(varargin) feval(name, served, varargin{:});
end
if has_result
  result = f(given{:});
else
  f(given{:});
end
end

function result = find_object(served, name, type, index)
if rr_served_has(served, ['get_', name])
  name = ['get_', name];
end
need(served, name);
found = served;
if isstruct(served) && ~isa(served.(name), 'function_handle')
  found = served.(name);
elseif ~isstruct(served) && any(strcmp(name, properties(served)))
  found = served.(name);
else
  found = call(served, name, true, index);
end
result = [];
if isempty(found)
  return
end
if ~isa(found, 'RobotRaconteurServed')
  if isempty(type)
    error('RobotRaconteur:InvalidOperation', ...
          '%s: a varobject has to be a RobotRaconteurServed, which has a type', name);
  end
  found = RobotRaconteurServed(type, found);
end
result = {found.rr_h, found};
end
