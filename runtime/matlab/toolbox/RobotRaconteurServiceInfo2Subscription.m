classdef RobotRaconteurServiceInfo2Subscription < RobotRaconteurHandle
  %ROBOTRACONTEURSERVICEINFO2SUBSCRIPTION Services that are found, without connecting.
  methods
    function obj = RobotRaconteurServiceInfo2Subscription(number)
      obj.rr_h = number;
    end
    function found = GetDetectedServiceInfo2(obj)
      %GETDETECTEDSERVICEINFO2 Those that are there now, as a struct array.
      found = rrmex('info_services', obj);
    end
    function listener = addlistener(obj, event, handler)
      %ADDLISTENER ServiceDetected and ServiceLost: handler(service).
      listener = RobotRaconteurListener(rrmex('info_listen', obj, event, handler));
    end
    function Close(obj)
      %CLOSE End the subscription: its listeners are not called any more.
      rrmex('info_close', obj);
    end
  end
end
