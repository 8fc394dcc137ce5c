classdef ConformanceService < handle
  %CONFORMANCESERVICE The role `serve`: offers what service.json says, as objects of the toolbox.
  properties (Constant)
    Patience = 0;
  end
  properties
    IsStarted = false;
    Services  % by name
    PutOff    % cells of {time, function}
  end
  methods
    function Work(obj)
      if ~obj.IsStarted
        pause(0.01);
        return
      end
      RobotRaconteur.Poll(0.005);
      while ~isempty(obj.PutOff) && now() >= obj.PutOff{1}{1}
        what = obj.PutOff{1}{2};
        obj.PutOff(1) = [];
        what();
      end
    end

    function answer = Answer(obj, request)
      switch request.do
        case 'start'
          answer = struct('port', obj.Start(request));
        case 'close_service'
          service = obj.Services(request.service);
          service.Close();
          answer = struct('done', true);
      end
    end

    function port = Start(obj, request)
      RobotRaconteur.Shutdown();
      RobotRaconteur.SetNodeOptions(conformance_node_options(request));
      obj.Services = containers.Map();
      obj.PutOff = {};
      for i = 1:numel(request.services)
        type = request.services{i}.object;
        texts = conformance_mex('definitions', type(1:find(type == '.', 1, 'last') - 1));
        cellfun(@RobotRaconteur.RegisterServiceType, texts);
      end
      for i = 1:numel(request.services)
        obj.Offer(request.services{i}, request.services);
      end
      obj.IsStarted = true;
      port = 0;
      channel = struct('name', 'tcp');
      if isfield(request, 'channel')
        channel = request.channel;
      end
      if strcmp(channel.name, 'local')
        RobotRaconteur.Listen(['rr+local://', channel.path]);
      else
        port = RobotRaconteur.StartServer(0, '127.0.0.1');
      end
    end

    function Offer(obj, service, all)
      type = service.object;
      options = struct('ExtraImports', {{}});
      if isfield(service, 'attributes')
        options.Attributes = structfun(@(value) conformance_mex('value', 'varvalue', value), ...
                                       service.attributes, 'UniformOutput', false);
      end
      if isfield(service, 'auth')
        options.Users = service.auth.password_file;
        policies = service.auth.policies;
        options.RequireUser = isfield(policies, 'requirevaliduser') && ...
                              strcmp(policies.requirevaliduser, 'true');
      end
      home = ConformanceHome(obj, service.name);
      script = ConformanceScript(type, script_of(service, all), home);
      home.Service = RobotRaconteur.RegisterService(service.name, type, script.Served, options);
      obj.Services(service.name) = home.Service;
    end

    function DoLater(obj, what)
      %DOLATER Do it once what happens now has been answered: 50 ms behind.
      obj.PutOff{end + 1} = {now() + 0.05 / 86400, what};
    end
  end
end

function node = script_of(service, all)
% The script of a service's root: its own, or "as NAME" for that of another.
node = service.node;
if ischar(node)
  names = cellfun(@(one) one.name, all, 'UniformOutput', false);
  node = all{strcmp(names, strrep(node, 'as ', ''))}.node;
end
end
