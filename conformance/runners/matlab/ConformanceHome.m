classdef ConformanceHome < handle
  %CONFORMANCEHOME The service that scripted objects belong to, for those that act on it.
  properties
    Player
    Name
    Service
  end
  methods
    function obj = ConformanceHome(player, name)
      obj.Player = player;
      obj.Name = name;
    end
    function Release(obj, path)
      obj.Service.ReleasePath([obj.Name, '.', path]);
    end
  end
end
