function rr_show(obj)
  % What disp shows of an object: type, path, members with the values that can be read.
  if obj.rr_h == 0
    fprintf('  closed object of a service\n');
    return
  end
  about = rrmex('about', obj);
  fprintf('  %s at %s\n', about.type, about.path);
  if ~about.is_open
    fprintf('  the connection has ended\n');
    return
  end
  [names, declarations] = rrmex('members', obj);
  for i = 1:numel(names)
    fprintf('    %s%s\n', declarations{i}, rr_shown_value(obj, names{i}, declarations{i}));
  end
end
