function rr_compile_mex(output, sources, place, varargin)
%RR_COMPILE_MEX Build the MEX file rrmex in the folder output: with mkoctfile in Octave, mex in MATLAB.
%   sources are files with mexFunction and what it needs besides the runtime. place tells where that is:
%   includes   folders for the compiler
%   own        the folder of the runtime's sources
%   static     the folder of what a file for MATLAB needs besides them
%   library    the archive of these as it was built for Octave; '' to compile the sources
%   archives   what the sources need besides the wire runtime: the archives of the dynamic client
%   runtime    the archives of the wire runtime, its core last
%   exports    the linker's list of names that are seen outside, in Octave
%   with_mex   true to build with mex, as MATLAB does
%   More arguments go to the compiler. In MATLAB it must be one that knows C++20; see `mex -setup C++`.
if place.with_mex
  compile_for_matlab(output, with_own_sources(sources, place), place, varargin);
elseif isempty(place.library)
  compile_for_octave(output, with_own_sources(sources, place), place, [place.archives, place.runtime], varargin);
else
  compile_for_octave(output, sources, place, [{place.library}, place.runtime], varargin);
end
end

function sources = with_own_sources(sources, place)
files = dir(fullfile(place.own, '*.cpp'));
names = setdiff({files.name}, 'rrmex.cpp');
sources = [sources, cellfun(@(name) fullfile(place.own, name), names, 'UniformOutput', false)];
end

function compile_for_octave(output, sources, place, archives, more)
% Octave is linked with the system's libstdc++ and throws exceptions through this file: both must have the
% same. OpenSSL, too, is the system's, which Octave's own libraries use.
includes = strcat('-I', place.includes);
libraries = {'-lfmt', '-lantlr4-runtime', '-lssl', '-lcrypto', '-lcrypt'};
% mkoctfile takes the compiler's flags from the environment; it is put back.
before = getenv('CXXFLAGS');
restore = onCleanup(@() setenv('CXXFLAGS', before));
setenv('CXXFLAGS', '-O2 -std=c++20 -fvisibility=hidden -DRR_OCTAVE');
linking = {'-Wl,-u,rr_component_tls', '-Wl,-u,rr_component_web', ...
           ['-Wl,--version-script=', place.exports], '-Wl,-z,nodelete'};
given = [includes, more, {'-o', fullfile(output, 'rrmex.mex')}, sources, archives, libraries, linking];
text = '';
status = 1;
[text, status] = mkoctfile('--mex', given{:});  % Octave
if status ~= 0
  error('RobotRaconteur:OperationFailed', 'mkoctfile has failed: %s', text);
end
end

function compile_for_matlab(output, sources, place, more)
% MATLAB brings its own libstdc++ and OpenSSL along. All that this file needs is inside, and nothing of it
% is seen outside: MATLAB's mex links with a list of names that exports mexFunction alone, and names of
% archives are hidden whatever it does.
includes = strcat('-I', place.includes);
sources{end + 1} = fullfile(place.static, 'parts.cpp');
% Before MATLAB's own libraries, of which -lstdc++ is one: what is found here is not taken from there.
inside = ['-Wl,-u,rr_component_tls -Wl,-u,rr_component_web -Wl,-u,__cxa_pure_virtual ', ...
          '-Wl,-Bstatic -lantlr4-runtime -lssl -lcrypto -lcrypt -lstdc++ ', ...
          '-Wl,-Bdynamic -Wl,--as-needed'];
mex('-R2017b', ...  % complex numbers in two arrays
    'CXXFLAGS=$CXXFLAGS -std=c++20 -fvisibility=hidden -fvisibility-inlines-hidden', ...
    'LDFLAGS=$LDFLAGS -static-libstdc++ -static-libgcc -Wl,--exclude-libs,ALL -Wl,-z,nodelete', ...
    ['LINKLIBS=', inside, ' $LINKLIBS'], includes{:}, more{:}, '-outdir', output, '-output', 'rrmex', ...
    sources{:}, place.archives{:}, place.runtime{:}, '-lut');
end
