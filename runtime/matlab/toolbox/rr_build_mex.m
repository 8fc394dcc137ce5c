function rr_build_mex(folder, sources, prefix, varargin)
%RR_BUILD_MEX Build the MEX file rrmex with generated classes in it.
%   rr_build_mex(folder, sources, prefix, flags...) compiles the sources, which are named relative to
%   folder, into rrmex in that folder. prefix is where robdef is installed; flags go to the compiler.
%   Generated build functions call it: mkoctfile in Octave, mex in MATLAB.
if nargin < 3
  prefix = '/usr/local';
end
includes = {['-I', fullfile(prefix, 'include')], ['-I', fullfile(folder, 'client', 'cpp')], ...
            ['-I', fullfile(folder, 'client', 'mex')]};
files = in_folder(folder, sources(:)');
libraries = {'-lfmt', '-lantlr4-runtime', '-lssl', '-lcrypto', '-lcrypt'};
support = fullfile(prefix, 'share', 'robdef', 'matlab');
if exist('OCTAVE_VERSION', 'builtin')
  archives = in_folder(library_folder(prefix), {'librobdef_matlab_mex.a', 'librobdef_runtime.a'});
  % mkoctfile takes the compiler's flags from the environment; it is put back.
  before = getenv('CXXFLAGS');
  restore = onCleanup(@() setenv('CXXFLAGS', before));
  setenv('CXXFLAGS', '-O2 -std=c++20 -fvisibility=hidden -DRR_OCTAVE');
  linking = {['-Wl,--version-script=', fullfile(support, 'exports.map')], '-Wl,-z,nodelete'};
  [output, status] = mkoctfile('--mex', includes{:}, varargin{:}, ...
                               '-o', fullfile(folder, 'rrmex.mex'), ...
                               files{:}, archives{:}, libraries{:}, linking{:});
  if status ~= 0
    error('RobotRaconteur:OperationFailed', 'mkoctfile has failed: %s', output);
  end
else
  % The library is built for Octave: with MATLAB's headers the sources are compiled again.
  root = fullfile(support, 'source');
  own = dir(fullfile(root, 'runtime', 'matlab', 'src', '*.cpp'));
  own = {own(~strcmp({own.name}, 'rrmex.cpp')).name};
  files = [files, in_folder(fullfile(root, 'runtime', 'matlab', 'src'), own)];
  archives = in_folder(library_folder(prefix), ...
                       {'librobdef_serial.a', 'librobdef_dynamic.a', 'librobdef_runtime.a'});
  mex('CXXFLAGS=$CXXFLAGS -std=c++20 -fvisibility=hidden', includes{:}, ['-I', root], ...
      varargin{:}, '-outdir', folder, '-output', 'rrmex', files{:}, archives{:}, libraries{:});
end
end

function paths = in_folder(folder, names)
paths = cellfun(@(name) fullfile(folder, strrep(name, '/', filesep)), names, ...
                'UniformOutput', false);
end

function folder = library_folder(prefix)
for place = {'lib', 'lib64', 'lib/x86_64-linux-gnu', 'lib/aarch64-linux-gnu'}
  folder = fullfile(prefix, place{1});
  if exist(fullfile(folder, 'librobdef_runtime.a'), 'file')
    return
  end
end
error('RobotRaconteur:InvalidArgument', 'there is no librobdef_runtime.a below %s', prefix);
end
