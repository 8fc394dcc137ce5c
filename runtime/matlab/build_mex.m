function build_mex(build, output, from_sources, with_mex)
%BUILD_MEX Build the MEX file and put the toolbox beside it, with MATLAB's mex or Octave's mkoctfile.
%   build_mex(build, output) takes the libraries from a build of the tree (build/release after
%   `cmake --build --preset release`) and writes the toolbox to the folder `output`, which is then
%   added to the path. MATLAB compiles the runtime's sources; Octave does with
%   build_mex(build, output, true), and takes them from the build without.
%   On Windows `build` is the folder of the unpacked zip robdef-VERSION-windows-x64, whose libraries are taken
%   in MATLAB and in Octave. That is not tested.
%   build_mex(build, output, true, true) uses the function mex and what else MATLAB's file is made with, in
%   Octave too: for tests, with a function of this name.
if nargin < 3
  from_sources = false;
end
if nargin < 4
  with_mex = ~exist('OCTAVE_VERSION', 'builtin');
end
here = fileparts(mfilename('fullpath'));
top = fileparts(fileparts(here));
if ~exist(output, 'dir')
  mkdir(output);
end
copyfile(fullfile(here, 'toolbox', '*.m'), output);
if exist('OCTAVE_VERSION', 'builtin')
  copyfile(fullfile(here, 'toolbox', 'octave', '*.m'), output);
end
runtime = fullfile(build, 'runtime', 'cpp');
place.includes = {top, fullfile(here, 'include'), fullfile(top, 'runtime', 'cpp', 'include')};
place.own = fullfile(here, 'src');
place.static = fullfile(here, 'static');
place.windows = fullfile(here, 'windows');
place.with_mex = with_mex;
place.library = fullfile(build, 'runtime', 'matlab', 'librobdef_matlab_mex.a');
if from_sources
  place.library = '';
end
place.archives = {fullfile(runtime, 'src', 'serial', 'librobdef_serial.a'), ...
                  fullfile(runtime, 'src', 'dynamic', 'librobdef_dynamic.a')};
if ispc
  runtime = fullfile(build, 'lib');
  place.archives = {fullfile(runtime, 'librobdef_serial.a'), fullfile(runtime, 'librobdef_dynamic.a')};
  place.library = '';
end
place.runtime = {fullfile(runtime, 'librobdef_tls.a'), fullfile(runtime, 'librobdef_web.a'), ...
                 fullfile(runtime, 'librobdef.a')};
place.exports = fullfile(here, 'exports.map');
before = addpath(fullfile(here, 'toolbox'));
restore = onCleanup(@() path(before));
rr_compile_mex(output, {fullfile(here, 'src', 'rrmex.cpp')}, place);
end
