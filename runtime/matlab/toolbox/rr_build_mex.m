function rr_build_mex(folder, sources, prefix, varargin)
%RR_BUILD_MEX Build the MEX file rrmex with generated classes in it.
%   rr_build_mex(folder, sources, prefix, flags...) compiles the sources, which are named relative to
%   folder, into rrmex in that folder. prefix is where robdef is installed; flags go to the compiler.
%   Generated build functions call it: mkoctfile in Octave, mex in MATLAB.
if nargin < 3
  prefix = '/usr/local';
end
support = fullfile(prefix, 'share', 'robdef', 'matlab');
libraries = library_folder(prefix);
root = fullfile(support, 'source');
place.includes = {fullfile(prefix, 'include'), fullfile(folder, 'client', 'cpp'), ...
                  fullfile(folder, 'client', 'mex'), root};
place.own = fullfile(root, 'runtime', 'matlab', 'src');
place.library = fullfile(libraries, 'librobdef_matlab_mex.a');
place.archives = in_folder(libraries, {'librobdef_serial.a', 'librobdef_dynamic.a'});
place.runtime = in_folder(libraries, {'librobdef_tls.a', 'librobdef_web.a', 'librobdef.a'});
place.static = fullfile(root, 'runtime', 'matlab', 'static');
place.windows = fullfile(root, 'runtime', 'matlab', 'windows');
place.with_mex = ~exist('OCTAVE_VERSION', 'builtin');
place.exports = fullfile(support, 'exports.map');
rr_compile_mex(folder, in_folder(folder, sources(:)'), place, varargin{:});
end

function paths = in_folder(folder, names)
paths = cellfun(@(name) fullfile(folder, strrep(name, '/', filesep)), names, ...
                'UniformOutput', false);
end

function folder = library_folder(prefix)
for place = {'lib', 'lib64', 'lib/x86_64-linux-gnu', 'lib/aarch64-linux-gnu'}
  folder = fullfile(prefix, place{1});
  if exist(fullfile(folder, 'librobdef.a'), 'file')
    return
  end
end
error('RobotRaconteur:InvalidArgument', 'there is no librobdef.a below %s', prefix);
end
