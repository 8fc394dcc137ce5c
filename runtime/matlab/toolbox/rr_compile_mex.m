function rr_compile_mex(output, sources, place, varargin)
%RR_COMPILE_MEX Build the MEX file rrmex in the folder output: with mkoctfile in Octave, mex in MATLAB.
%   sources are files with mexFunction and what it needs besides the runtime. place tells where that is:
%   includes   folders for the compiler
%   own        the folder of the runtime's sources
%   static     the folder of what a file for MATLAB needs besides them
%   windows    the folder of what a file for Windows needs besides them
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
if ispc
  compile_for_octave_on_windows(output, sources, place, archives, more);
  return
end
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

function compile_for_octave_on_windows(output, sources, place, archives, more)
% Not tested. The archives are those of the zip for Windows, which have all other libraries inside; they need
% an Octave whose compiler is g++ 12 or later.
before = getenv('CXXFLAGS');
restore = onCleanup(@() setenv('CXXFLAGS', before));
setenv('CXXFLAGS', '-O2 -std=c++20 -Wno-attributes -Wa,-mbig-obj -DRR_OCTAVE');
sources{end + 1} = fullfile(place.windows, 'stay_loaded.cpp');
includes = strcat('-I', place.includes);
given = [includes, more, {'-o', fullfile(output, 'rrmex.mex')}, sources, archives, windows_libraries(place)];
text = '';
status = 1;
[text, status] = mkoctfile('--mex', given{:});  % Octave
if status ~= 0
  error('RobotRaconteur:OperationFailed', 'mkoctfile has failed: %s', text);
end
end

function libraries = windows_libraries(place)
folder = fileparts(place.runtime{end});
libraries = {fullfile(folder, 'libssl.a'), fullfile(folder, 'libcrypto.a'), '-Wl,-u,rr_component_tls', ...
             '-Wl,-u,rr_component_web', '-lws2_32', '-liphlpapi', '-ladvapi32', '-lbcrypt', ...
             '-lsynchronization', '-lcrypt32'};
end

function compile_for_matlab_on_windows(output, sources, place, more)
% Not tested in MATLAB; a test compiles and links the same with mingw-w64. `mex -setup C++` has to have
% chosen MinGW-w64, of g++ 12 or later: the archives are made by that.
sources{end + 1} = fullfile(place.windows, 'stay_loaded.cpp');
includes = strcat('-I', place.includes);
libraries = windows_libraries(place);
mex('-R2017b', ...  % complex numbers in two arrays
    'CXXFLAGS=$CXXFLAGS -std=c++20 -Wno-attributes -Wa,-mbig-obj', ...
    ['LINKLIBS=-static-libstdc++ -static-libgcc ', strjoin(libraries(3:end)), ' -Wl,-Bstatic -lwinpthread $LINKLIBS'], ...
    includes{:}, more{:}, '-outdir', output, '-output', 'rrmex', sources{:}, place.archives{:}, place.runtime{:}, ...
    libraries{1:2}, '-lut');
end

function compile_for_matlab(output, sources, place, more)
% MATLAB brings its own libstdc++ and OpenSSL along. All that this file needs is inside, and nothing of it
% is seen outside: MATLAB's mex links with a list of names that exports mexFunction alone, and names of
% archives are hidden whatever it does.
if ispc
  compile_for_matlab_on_windows(output, sources, place, more);
  return
end
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
