function answer = isvalid(obj)
%ISVALID Whether an object of a service is held. MATLAB's handles have this; Octave's have not.
answer = obj.rr_h ~= 0;
end
