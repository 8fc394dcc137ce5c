classdef RobotRaconteurService < handle
  %ROBOTRACONTEURSERVICE A service that this interpreter offers, until Close().
  %   Made by RobotRaconteur.RegisterService. Root is its object, a RobotRaconteurServed.
  properties
    % As it was registered.
    Name
    % The object that clients get first.
    Root
  end
  properties (Hidden)
    rr_h = uint64(0);
  end
  methods
    function obj = RobotRaconteurService(name, root, options)
      obj.Name = name;
      obj.Root = root;
      obj.rr_h = rrmex('register_service', name, root.rr_h, options);
    end
    function Close(obj)
      %CLOSE Tell all clients that the service ends.
      if obj.rr_h ~= 0
        rrmex('unregister_service', obj.rr_h);
        obj.rr_h = uint64(0);
      end
    end
    function SetRights(obj, rights)
      %SETRIGHTS Other rights from now on, a text of rules, for clients that are connected, too; [] for
      %   everything. They hold until RightsFile changes, if there is one.
      rrmex('set_rights', obj.rr_h, rights);
    end
    function numbers = Clients(obj)
      %CLIENTS The numbers of the clients, for CallBack.
      numbers = rrmex('service_clients', obj.rr_h);
    end
    function ReleasePath(obj, path)
      %RELEASEPATH Forget the object at a path, and tell all clients.
      rrmex('release_path', obj.rr_h, path);
    end
    function disp(obj)
      fprintf('  service %s\n', obj.Name);
    end
  end
end
