classdef timer < handle
  %TIMER As much of MATLAB's timer as the toolbox uses, for tests in Octave.
  %   t.Fire() does what MATLAB does at the end of a period.
  properties
    Name = '';
    ExecutionMode = 'singleShot';
    Period = 1;
    BusyMode = 'drop';
    ObjectVisibility = 'on';
    TimerFcn = '';
    Running = 'off';
  end
  methods
    function obj = timer(varargin)
      for k = 1:2:numel(varargin)
        obj.(varargin{k}) = varargin{k + 1};
      end
      timer_list(obj);
    end
    function start(obj)
      obj.Running = 'on';
    end
    function stop(obj)
      obj.Running = 'off';
    end
    function delete(obj)
      timer_list(obj, 'remove');
    end
    function Fire(obj)
      assert(obj.Running, 'on');
      event = struct('Type', 'TimerFcn', 'Data', struct('time', clock()));
      feval(obj.TimerFcn, obj, event);
    end
  end
end
