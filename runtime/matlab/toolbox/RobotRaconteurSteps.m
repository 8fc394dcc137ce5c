classdef RobotRaconteurSteps < handle
  %ROBOTRACONTEURSTEPS What a generator function of an object that is served gives, step by step:
  %   the cells of a cell array, or what next(value) of a struct gives.
  properties (Hidden)
    rr_source
    rr_next = 1;
  end
  methods
    function obj = RobotRaconteurSteps(source)
      if ~iscell(source) && ~(isstruct(source) && isfield(source, 'next'))
        error('RobotRaconteur:InvalidOperation', ...
              'a generator function gives a cell array, or a struct with next');
      end
      obj.rr_source = source;
    end
    function result = Step(obj, action, value)
      %STEP {value} of the next step; [] at the end.
      result = [];
      if ~strcmp(action, 'next')
        if isstruct(obj.rr_source) && isfield(obj.rr_source, action)
          feval(obj.rr_source.(action));
        end
        return
      end
      if iscell(obj.rr_source)
        if obj.rr_next <= numel(obj.rr_source)
          result = obj.rr_source(obj.rr_next);
          obj.rr_next = obj.rr_next + 1;
        end
        return
      end
      try
        result = {obj.rr_source.next(value)};
      catch err
        if ~strcmp(err.identifier, 'RobotRaconteur:StopIteration')
          rethrow(err);
        end
      end
    end
  end
end
