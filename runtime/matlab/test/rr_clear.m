function answer = rr_clear()
%RR_CLEAR Clear what the program has, from within a function that something of it has called.
evalin('base', 'clear all');
answer = 1;
end
