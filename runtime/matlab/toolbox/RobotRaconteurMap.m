classdef RobotRaconteurMap < handle
  %ROBOTRACONTEURMAP A map with texts as keys, of which one may be empty.
  %   A value of type T{string} is received as one if it has an empty key, which Octave's
  %   containers.Map does not take. It is used as that is: m('') = 5; m('key'), isKey(m, ''),
  %   keys(m), values(m), m.Count, remove(m, '').
  %   m = RobotRaconteurMap() is empty; m = RobotRaconteurMap(keys, values) has these cells.
  properties (Hidden)
    rr_items = [];  % the same with a letter before each key
  end
  properties (Dependent, SetAccess = private)
    Count
    KeyType
    ValueType
  end
  methods
    function obj = RobotRaconteurMap(keys, values)
      obj.rr_items = containers.Map('KeyType', 'char', 'ValueType', 'any');
      if nargin == 1
        error('RobotRaconteur:InvalidArgument', 'a map is made of keys and values');
      elseif nargin == 2
        if ischar(keys)
          keys = {keys};
          values = {values};
        end
        if ~iscell(keys) || ~iscell(values) || numel(keys) ~= numel(values)
          error('RobotRaconteur:InvalidArgument', 'expected as many keys as values, in cells');
        end
        for i = 1:numel(keys)
          obj.rr_items(rr_held(keys{i})) = values{i};
        end
      end
    end
    function found = keys(obj)
      %KEYS All keys, a row of characters in each cell.
      found = cellfun(@(key) rr_row(key(2:end)), keys(obj.rr_items), 'UniformOutput', false);
    end
    function found = values(obj, keys)
      %VALUES All values in cells, in the order of the keys; or those of some keys, given in a
      %   cell array.
      if nargin == 1
        found = values(obj.rr_items);
      else
        found = values(obj.rr_items, cellfun(@rr_held, keys, 'UniformOutput', false));
      end
    end
    function answer = isKey(obj, keys)
      %ISKEY Whether there is a value of a key; of a cell array of keys, one answer for each.
      if iscell(keys)
        answer = cellfun(@(key) isKey(obj, key), keys);
      else
        answer = rr_is_key(keys) && isKey(obj.rr_items, rr_held(keys));
      end
    end
    function obj = remove(obj, keys)
      %REMOVE Remove the value of a key, or of each key in a cell array.
      if ~iscell(keys)
        keys = {keys};
      end
      remove(obj.rr_items, cellfun(@rr_held, keys, 'UniformOutput', false));
    end
    function count = get.Count(obj)
      count = obj.rr_items.Count;
    end
    function type = get.KeyType(obj)
      type = 'char';
    end
    function type = get.ValueType(obj)
      type = 'any';
    end
    function count = length(obj)
      %LENGTH How many values there are.
      count = obj.rr_items.Count;
    end
    function count = numel(obj, varargin)
      count = 1;
      if nargin == 1
        count = obj.rr_items.Count;
      end
    end
    function answer = isempty(obj)
      %ISEMPTY Whether there are no values.
      answer = obj.rr_items.Count == 0;
    end
    function count = numArgumentsFromSubscript(obj, s, context)
      % MATLAB asks for so many results of subsref; Octave does not call this.
      count = 1;
      if ~strcmp(char(context), 'Assignment')
        count = rr_result_count([], s);
      end
    end
    function varargout = subsref(obj, s)
      if strcmp(s(1).type, '.')
        [varargout{1:max(nargout, rr_result_count([], s))}] = builtin('subsref', obj, s);
        return
      end
      value = obj.rr_items(rr_key_of(s(1)));
      if numel(s) > 1
        [varargout{1:max(nargout, 1)}] = subsref(value, s(2:end));
      else
        varargout = {value};
      end
    end
    function obj = subsasgn(obj, s, value)
      if strcmp(s(1).type, '.')
        error('RobotRaconteur:InvalidOperation', 'a map is changed by its keys');
      end
      key = rr_key_of(s(1));
      if numel(s) > 1
        value = subsasgn(obj.rr_items(key), s(2:end), value);
      end
      obj.rr_items(key) = value;
    end
    function answer = isequal(a, b)
      %ISEQUAL The same keys and values.
      answer = rr_isequal(a, b);
    end
    function disp(obj)
      fprintf('  RobotRaconteurMap with %d keys\n', obj.rr_items.Count);
    end
  end
end

function key = rr_key_of(s)
if ~strcmp(s.type, '()') || numel(s.subs) ~= 1
  error('RobotRaconteur:InvalidArgument', 'a map is indexed by one key in parentheses');
end
key = rr_held(s.subs{1});
end

function answer = rr_is_key(key)
answer = ischar(key) && (isempty(key) || isrow(key));
end

function key = rr_held(key)
if ~rr_is_key(key)
  error('RobotRaconteur:InvalidArgument', 'the keys of the map are texts');
end
key = ['k', key];
end

function key = rr_row(key)
% As texts are that are received: none is 1 by 0.
if isempty(key)
  key = '';
end
end
