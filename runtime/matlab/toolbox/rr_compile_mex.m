function rr_compile_mex(output, sources, place, varargin)
%RR_COMPILE_MEX Build the MEX file rrmex in the folder output: with mkoctfile in Octave, mex in MATLAB.
%   sources are files with mexFunction and what it needs besides the runtime. place tells where that is:
%   includes   folders for the compiler
%   own        the folder of the runtime's sources
%   library    the archive of these as it was built for Octave; '' to compile the sources
%   archives   what the sources need: the archives of the dynamic client and of the wire runtime
%   exports    the linker's list of names that are seen outside
%   More arguments go to the compiler. In MATLAB it must be one that knows C++20; see `mex -setup C++`.
is_octave = exist('OCTAVE_VERSION', 'builtin') ~= 0;
archives = place.archives;
if is_octave && ~isempty(place.library)
  archives = {place.library, archives{end}};
else
  % MATLAB's headers mean other types than Octave's.
  files = dir(fullfile(place.own, '*.cpp'));
  names = setdiff({files.name}, 'rrmex.cpp');
  sources = [sources, cellfun(@(name) fullfile(place.own, name), names, 'UniformOutput', false)];
end
includes = strcat('-I', place.includes);
libraries = {'-lfmt', '-lantlr4-runtime', '-lssl', '-lcrypto', '-lcrypt'};
if is_octave
  % mkoctfile takes the compiler's flags from the environment; it is put back.
  before = getenv('CXXFLAGS');
  restore = onCleanup(@() setenv('CXXFLAGS', before));
  setenv('CXXFLAGS', '-O2 -std=c++20 -fvisibility=hidden -DRR_OCTAVE');
  linking = {['-Wl,--version-script=', place.exports], '-Wl,-z,nodelete'};
  [text, status] = mkoctfile('--mex', includes{:}, varargin{:}, '-o', fullfile(output, 'rrmex.mex'), ...
                             sources{:}, archives{:}, libraries{:}, linking{:});
  if status ~= 0
    error('RobotRaconteur:OperationFailed', 'mkoctfile has failed: %s', text);
  end
else
  mex('CXXFLAGS=$CXXFLAGS -std=c++20 -fvisibility=hidden', includes{:}, varargin{:}, ...
      '-outdir', output, '-output', 'rrmex', sources{:}, archives{:}, libraries{:}, '-lut');
end
end
