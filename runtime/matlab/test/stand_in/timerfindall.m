function found = timerfindall(property, value)
%TIMERFINDALL The timer with this value of a property; [] for none.
found = [];
for one = timer_list()
  if strcmp(one{1}.(property), value)
    found = one{1};
  end
end
end
