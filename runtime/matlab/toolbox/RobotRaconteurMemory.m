classdef RobotRaconteurMemory < handle
  %ROBOTRACONTEURMEMORY A memory of an object, read and written by indexing.
  %   size(m);  a = m(:);  m(:) = a;  b = m(1:100, 1:100, 1);  m(5:8, 2) = c;
  %   Each reads or writes at the service. What is read between the indexes is left out here;
  %   what is written must be without gaps.
  properties (Hidden)
    rr_object = [];
    rr_name = '';
  end
  methods
    function obj = RobotRaconteurMemory(object, name)
      obj.rr_object = object;
      obj.rr_name = name;
    end
    function varargout = size(obj, dimension)
      dims = rrmex('memory_dims', obj.rr_object, obj.rr_name);
      dims(end + 1:2) = 1;
      if nargin == 2
        dims(end + 1:dimension) = 1;
        varargout = {dims(dimension)};
      elseif nargout < 2
        varargout = {dims};
      else
        dims(end + 1:nargout) = 1;
        varargout = num2cell([dims(1:nargout - 1), prod(dims(nargout:end))]);
      end
    end
    function count = numel(obj, varargin)
      % Octave asks this for each index, where it means one result.
      count = 1;
      if nargin == 1
        count = prod(size(obj));
      end
    end
    function count = length(obj)
      count = max(size(obj));
    end
    function answer = numArgumentsFromSubscript(obj, s, context)
      answer = 1;
    end
    function last = end(obj, k, n)
      dims = rrmex('memory_dims', obj.rr_object, obj.rr_name);
      dims(end + 1:n) = 1;
      last = dims(k);
      if n == 1
        last = prod(dims);
      end
    end
    function varargout = subsref(obj, s)
      if strcmp(s(1).type, '.')
        [varargout{1:nargout}] = builtin('subsref', obj, s);
        return
      end
      dims = rrmex('memory_dims', obj.rr_object, obj.rr_name);
      [first, count, picked] = rr_memory_ranges(s(1), dims);
      items = rrmex('memory_read', obj.rr_object, obj.rr_name, first - 1, count);
      items = rr_memory_pick(items, count, picked, numel(s(1).subs));
      if numel(s) > 1
        items = subsref(items, s(2:end));
      end
      varargout = {items};
    end
    function obj = subsasgn(obj, s, items)
      if strcmp(s(1).type, '.')
        obj = builtin('subsasgn', obj, s, items);
        return
      end
      dims = rrmex('memory_dims', obj.rr_object, obj.rr_name);
      [first, count, picked] = rr_memory_ranges(s(1), dims);
      if numel(s) > 1 || any(~cellfun(@isempty, picked))
        error('RobotRaconteur:InvalidArgument', 'a memory is written without gaps');
      end
      items = rr_memory_shape(items, count);
      if prod(count) ~= 0
        rrmex('memory_write', obj.rr_object, obj.rr_name, first - 1, items);
      end
    end
    function disp(obj)
      fprintf('  memory %s\n', obj.rr_name);
    end
  end
end
