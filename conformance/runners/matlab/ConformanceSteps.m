classdef ConformanceSteps < handle
  %CONFORMANCESTEPS The steps that a script tells for a generator: `yield` values or `accept` so many,
  %   then the end, or instead of it the error `end`.
  properties
    Steps
    Type
    Given = 0;
  end
  methods
    function obj = ConformanceSteps(steps, type)
      obj.Steps = steps;
      obj.Type = type;
    end
    function value = Next(obj)
      value = [];
      if isfield(obj.Steps, 'yield')
        count = numel(obj.Steps.yield);
      else
        count = obj.Steps.accept;
      end
      if obj.Given == count
        if isfield(obj.Steps, 'end')
          conformance_raise(obj.Steps.end, {});
        end
        error('RobotRaconteur:StopIteration', 'no more');
      end
      obj.Given = obj.Given + 1;
      if ~isempty(obj.Type)
        value = conformance_mex('value', obj.Type, obj.Steps.yield{obj.Given});
      end
    end
  end
end
