function robdef_install(with_mex)
%ROBDEF_INSTALL Build the toolbox in this folder and add it to the path.
%   robdef_install compiles the MEX file with MATLAB's mex, which takes some minutes, and adds the folder
%   toolbox to the path, for later sessions too where that may be saved. It needs a compiler that knows
%   C++20 (mex -setup C++) and the packages libantlr4-runtime-dev, libssl-dev and libcrypt-dev of Debian 12.
%   Not tested in MATLAB: the same steps run in Octave, with a stand-in for mex.
if nargin < 1
  with_mex = ~exist('OCTAVE_VERSION', 'builtin');
end
here = fileparts(mfilename('fullpath'));
toolbox = fullfile(here, 'toolbox');
addpath(fullfile(here, 'runtime', 'matlab'));
restore = onCleanup(@() rmpath(fullfile(here, 'runtime', 'matlab')));
build_mex(fullfile(here, 'build'), toolbox, true, with_mex);
addpath(toolbox);
if savepath() ~= 0
  warning('RobotRaconteur:Path', 'The path could not be saved: call addpath(''%s'') in each session.', toolbox);
end
fprintf('The toolbox is in %s. Try: RobotRaconteur.Connect(url)\n', toolbox);
end
