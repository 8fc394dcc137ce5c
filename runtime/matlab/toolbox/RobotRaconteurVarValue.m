classdef RobotRaconteurVarValue
  %ROBOTRACONTEURVARVALUE A value with the type that it has for the service.
  %   v = RobotRaconteurVarValue(data, datatype), as RobotRaconteurVarValue(5, 'int16[]'). A value
  %   of type varvalue is received as one. datatype is spelled as in a service definition, with
  %   named types in full; 'null' has no data.
  properties
    % The value; [] of null.
    data = [];
    % As in a service definition: 'int16[]'.
    datatype = 'null';
  end
  methods
    function obj = RobotRaconteurVarValue(data, datatype)
      if nargin == 2
        obj.data = data;
        obj.datatype = datatype;
      elseif nargin == 1
        error('RobotRaconteur:InvalidArgument', 'a RobotRaconteurVarValue needs a type');
      end
    end
    function disp(obj)
      fprintf('%s', obj.as_text());
    end
    function text = as_text(obj)
      %AS_TEXT One line for the screen.
      text = sprintf('  RobotRaconteurVarValue of %s\n', obj.datatype);
    end
    function answer = isequal(a, b)
      %ISEQUAL The same type and the same data.
      answer = isa(a, 'RobotRaconteurVarValue') && isa(b, 'RobotRaconteurVarValue') && ...
               strcmp(a.datatype, b.datatype) && rr_isequal(a.data, b.data);
    end
  end
end
