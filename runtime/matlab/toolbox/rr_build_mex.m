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
libraries = {['-L', fullfile(prefix, 'lib')], '-lrobdef_matlab_mex', ...
             '-lrobdef_runtime', '-lfmt', '-lantlr4-runtime'};
files = cellfun(@(name) fullfile(folder, strrep(name, '/', filesep)), sources(:)', ...
                'UniformOutput', false);
if exist('OCTAVE_VERSION', 'builtin')
  % What mkoctfile asks for its flags is the environment; the user's are put back.
  before = getenv('CXXFLAGS');
  restore = onCleanup(@() setenv('CXXFLAGS', before));
  setenv('CXXFLAGS', '-O2 -std=c++20 -fvisibility=hidden -DRR_OCTAVE');
  exports = fullfile(prefix, 'share', 'robdef', 'matlab', 'exports.map');
  linking = {['-Wl,--version-script=', exports], '-Wl,-z,nodelete'};
  [output, status] = mkoctfile('--mex', includes{:}, varargin{:}, ...
                               '-o', fullfile(folder, 'rrmex.mex'), ...
                               files{:}, libraries{:}, linking{:});
  if status ~= 0
    error('RobotRaconteur:OperationFailed', 'mkoctfile has failed: %s', output);
  end
else
  % The library is built for Octave: MATLAB's own headers mean other types.
  root = fullfile(prefix, 'share', 'robdef', 'matlab', 'source');
  found = dir(fullfile(root, 'runtime', 'matlab', 'src', '*.cpp'));
  found = found(~strcmp({found.name}, 'rrmex.cpp'));
  files = [files, fullfile(root, 'runtime', 'matlab', 'src', {found.name})];
  includes{end + 1} = ['-I', root];
  libraries{2} = '-lrobdef_dynamic';
  mex('CXXFLAGS=$CXXFLAGS -std=c++20 -fvisibility=hidden', includes{:}, varargin{:}, ...
      '-outdir', folder, '-output', 'rrmex', files{:}, libraries{:});
end
end
