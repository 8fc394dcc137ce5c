classdef RobotRaconteurMemory < handle
  %ROBOTRACONTEURMEMORY A memory of an object, read and written by indexing.
  %   size(m);  a = m(:);  m(:) = a;  b = m(1:100, 1:100, 1);  m(5:8, 2) = c;
  %   Each reads or writes at the service. What is read between the indexes is left out here;
  %   what is written must be without gaps. Where an index leaves it open, as `:` and `end` do, or
  %   the memory has several dimensions, the service is asked for the sizes first; Read and Write,
  %   which are told all, ask for nothing.
  properties (Hidden)
    rr_object = [];
    rr_name = '';
  end
  methods
    function obj = RobotRaconteurMemory(object, name)
      obj.rr_object = object;
      obj.rr_name = name;
    end
    function items = Read(obj, first, count)
      %READ m.Read([2 1], [3 1]): so many items in each dimension, from those counted from 1 on.
      items = rrmex('memory_read', obj.rr_object, obj.rr_name, first - 1, count);
    end
    function Write(obj, first, items)
      %WRITE m.Write([2 1], items): an array, to the place that begins there.
      rrmex('memory_write', obj.rr_object, obj.rr_name, first - 1, items);
    end
    function count = Length(obj)
      %LENGTH Items of a memory of one dimension.
      count = rrmex('memory_length', obj.rr_object, obj.rr_name);
    end
    function dims = Dimensions(obj)
      %DIMENSIONS A row of sizes, as the service has them; size(m) has two at least.
      dims = rrmex('memory_dims', obj.rr_object, obj.rr_name);
    end
    function count = DimCount(obj)
      %DIMCOUNT How many dimensions it has.
      count = rrmex('memory_dim_count', obj.rr_object, obj.rr_name);
    end
    function varargout = size(obj, dimension)
      %SIZE Length of each dimension. Asks the service.
      dims = rrmex('memory_dims', obj.rr_object, obj.rr_name);
      if nargin == 2
        varargout = rr_sizes(dims, 1, dimension);
      else
        varargout = rr_sizes(dims, max(nargout, 1));
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
      %LENGTH The longest dimension. Asks the service.
      count = max(size(obj));
    end
    function count = numArgumentsFromSubscript(obj, s, context)
      % MATLAB asks for so many results of subsref; Octave does not call this.
      count = 1;
      if ~strcmp(char(context), 'Assignment')
        count = rr_result_count([], s);
      end
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
      [first, count, picked] = rr_memory_ranges(s(1), obj);
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
      [first, count, picked] = rr_memory_ranges(s(1), obj);
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
