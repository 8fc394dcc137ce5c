function answer = rr_served_has(served, name)
%RR_SERVED_HAS Whether an object that is served has a member of this name.
if isstruct(served)
  answer = isfield(served, name);
else
  answer = any(strcmp(name, properties(served))) || any(strcmp(name, methods(served)));
end
end
