classdef RobotRaconteurPipe < handle
  %ROBOTRACONTEURPIPE A pipe of an object: endpoint = obj.pipe.Connect(-1).
  properties (Hidden)
    rr_object = [];
    rr_name = '';
  end
  methods
    function obj = RobotRaconteurPipe(object, name)
      obj.rr_object = object;
      obj.rr_name = name;
    end
    function endpoint = Connect(obj, index)
      %CONNECT An endpoint with this index; -1, and none, leave it to the service.
      if nargin < 2
        index = -1;
      end
      endpoint = RobotRaconteurPipeEndpoint( ...
        rrmex('pipe_connect', obj.rr_object, obj.rr_name, index));
    end
    function disp(obj)
      fprintf('  pipe %s\n', obj.rr_name);
    end
  end
end
