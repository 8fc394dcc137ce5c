classdef RobotRaconteurGenerator < RobotRaconteurHandle
  %ROBOTRACONTEURGENERATOR Values that a service gives, or takes, one after the other.
  methods
    function obj = RobotRaconteurGenerator(number)
      obj.rr_h = number;
    end
    function value = Next(obj, varargin)
      %NEXT The next value; `parameter` for generators that take one. RobotRaconteur:StopIteration
      %   at the end.
      [is_there, value] = rrmex('generator_next', obj, varargin{:});
      if ~is_there
        RobotRaconteur.ThrowError(struct('name', 'RobotRaconteur.StopIteration', ...
                                         'message', 'the generator has ended'));
      end
    end
    function [is_there, value] = TryNext(obj, varargin)
      %TRYNEXT [is_there, value], or with one result the cell {is_there, value}.
      [is_there, value] = rrmex('generator_next', obj, varargin{:});
      if nargout < 2
        is_there = {is_there, value};
      end
    end
    function values = NextAll(obj, most_bytes)
      %NEXTALL All values that are left, in a column of cells.
      %   values = g.NextAll(most_bytes) ends with RobotRaconteur:OutOfSystemResource when they take
      %   more memory than this, Inf for no limit. Without it the limit is that of the node's
      %   sessions: 64 MiB, or ClientSessionLimit of RobotRaconteur.SetNodeOptions. The generator
      %   can be used further; the values that were read are lost.
      if nargin < 2
        most_bytes = [];
      end
      values = rrmex('generator_all', obj, most_bytes);
    end
    function async_Next(obj, varargin)
      %ASYNC_NEXT async_Next([value,] handler, parameter, seconds): handler(parameter, value, err).
      given = {};
      if numel(varargin) > 0 && ~isa(varargin{1}, 'function_handle')
        given = varargin(1);
        varargin(1) = [];
      end
      varargin(end + 1:3) = {[]};
      if isempty(varargin{3})
        varargin{3} = -1;
      end
      rrmex('generator_async_next', obj, varargin{1:3}, given{:});
    end
    function Close(obj)
      %CLOSE No more values are wanted; the service ends its work in order.
      rrmex('generator_end', obj, false);
    end
    function Abort(obj)
      %ABORT The service is to break off.
      rrmex('generator_end', obj, true);
    end
  end
end
