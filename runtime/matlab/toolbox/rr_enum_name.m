function name = rr_enum_name(type, names, numbers, number)
%RR_ENUM_NAME The name of an enum's value, for the classes of enums that are generated.
found = find(numbers == number, 1);
if isempty(found)
  known = cellfun(@(one, value) sprintf('%s (%d)', one, value), names, num2cell(numbers), ...
                  'UniformOutput', false);
  error('RobotRaconteur:OutOfRange', '`%s` has no value %s: %s', type, num2str(number), ...
        strjoin(known, ', '));
end
name = names{found};
end
