function value = rr_wrap(obj, value, kind)
  % What is behind a member of `obj`, by the number that the MEX file gives for its kind.
  switch kind
    case 3
      value = RobotRaconteurObject(value);
    case 4
      value = RobotRaconteurGenerator(value);
    case 5
      value = RobotRaconteurWire(obj, value);
    case 6
      value = RobotRaconteurPipe(obj, value);
    case 7
      value = RobotRaconteurMemory(obj, value);
  end
end
