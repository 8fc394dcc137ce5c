function build_mex(build, output, only_show)
%BUILD_MEX Build the MEX file and put the toolbox beside it, with MATLAB's mex or Octave's mkoctfile.
%   build_mex(build, output) takes the libraries from a build of the tree (build/release after
%   `cmake --build --preset release`) and writes the toolbox to the folder `output`, which is then
%   added to the path. build_mex(build, output, true) only shows the commands.
%   In MATLAB the compiler must be one that knows C++20; see `mex -setup C++`.
if nargin < 3
  only_show = false;
end
here = fileparts(mfilename('fullpath'));
top = fileparts(fileparts(here));
is_octave = exist('OCTAVE_VERSION', 'builtin') ~= 0;
if ~exist(output, 'dir')
  mkdir(output);
end
files = dir(fullfile(here, 'src', '*.cpp'));
sources = cellfun(@(name) fullfile(here, 'src', name), {files.name}, 'UniformOutput', false);
includes = {['-I', top], ['-I', fullfile(here, 'include')], ...
            ['-I', fullfile(top, 'runtime', 'cpp', 'include')]};
libraries = {fullfile(build, 'runtime', 'cpp', 'src', 'serial', 'librobdef_serial.a'), ...
             fullfile(build, 'runtime', 'cpp', 'src', 'dynamic', 'librobdef_dynamic.a'), ...
             fullfile(build, 'runtime', 'cpp', 'librobdef_runtime.a'), '-lantlr4-runtime', ...
             '-lfmt', '-lssl', '-lcrypto', '-lcrypt'};
if is_octave
  setenv('CXXFLAGS', '-O2 -std=c++20 -fvisibility=hidden');
  command = {'mkoctfile', '--mex', '-DRR_OCTAVE', includes{:}, '-o', ...
             fullfile(output, 'rrmex.mex'), sources{:}, libraries{:}};
  run = @(words) mkoctfile(words{2:end});
else
  command = {'mex', 'CXXFLAGS=$CXXFLAGS -std=c++20 -fvisibility=hidden', includes{:}, ...
             '-output', fullfile(output, 'rrmex'), sources{:}, libraries{:}, '-lut'};
  run = @(words) mex(words{2:end});
end
if only_show
  fprintf('%s\n', strjoin(command, ' '));
else
  run(command);
  copyfile(fullfile(here, 'toolbox', '*.m'), output);
  if is_octave
    copyfile(fullfile(here, 'toolbox', 'octave', '*.m'), output);
  end
end
end
