function answer = rr_eventually(condition, seconds)
%RR_EVENTUALLY Whether a condition comes true in time; events are handled meanwhile.
if nargin < 2
  seconds = 20;
end
start = tic();
answer = condition();
while ~answer && toc(start) < seconds
  RobotRaconteur.Poll(0.01);
  answer = condition();
end
end
