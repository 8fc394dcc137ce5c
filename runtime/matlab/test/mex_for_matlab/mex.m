function mex(varargin)
%MEX As much of MATLAB's mex as the toolbox uses, with g++ and Octave's headers, for tests in Octave.
%   Flags stand where MATLAB's have them; as in MATLAB, the libraries end with -lstdc++, and the linker has a
%   list of names that are exported. RR_TEST_COMPILER is the compiler, with ccache before it if there is one;
%   RR_TEST_FOLDER where objects go. Nothing is optimized, as this is about names.
folder = getenv('RR_TEST_FOLDER');
set = struct('CXXFLAGS', '-fexceptions -fPIC -fno-omit-frame-pointer -pthread', 'LDFLAGS', '-pthread', ...
             'LINKLIBS', '-lm -lstdc++');
options = {};
sources = {};
archives = {};
k = 1;
while k <= numel(varargin)
  one = varargin{k};
  given = regexp(one, '^(\w+)=(.*)$', 'tokens', 'once');
  if ~isempty(given)
    name = given{1};
    set.(name) = strrep(given{2}, ['$', name], set.(name));
  elseif any(strcmp(one, {'-outdir', '-output'}))
    set.(one(2:end)) = varargin{k + 1};
    k = k + 1;
  elseif strcmp(one, '-R2017b')
    set.api = one;
  elseif strncmp(one, '-I', 2) || strncmp(one, '-D', 2)
    options{end + 1} = one;
  elseif strncmp(one, '-l', 2) || strcmp(one(end - 1:end), '.a')
    archives{end + 1} = one;
  else
    assert(strcmp(one(end - 3:end), '.cpp'), 'mex does not know %s', one);
    sources{end + 1} = one;
  end
  k = k + 1;
end
assert(set.api, '-R2017b');
compiler = getenv('RR_TEST_COMPILER');
headers = getenv('RR_TEST_HEADERS');
objects = cell(size(sources));
for k = 1:numel(sources)
  objects{k} = fullfile(folder, sprintf('%d.o', k));
  run([compiler, ' ', set.CXXFLAGS, ' -O0 -isystem ', headers, ' ', strjoin(options, ' '), ' -c ', sources{k}, ...
       ' -o ', objects{k}]);
end
% MATLAB's own library that knows of Ctrl-C.
stub = fullfile(folder, 'ut.cpp');
write(stub, 'extern "C" bool utIsInterruptPending() { return false; }');
run([compiler, ' -shared -fPIC -o ', fullfile(set.outdir, 'libut.so'), ' ', stub]);
exports = fullfile(folder, 'mexFunction.map');
write(exports, '{ global: mexFunction; mexfilerequiredapiversion; local: *; };');
run([compiler, ' ', set.LDFLAGS, ' -shared -Wl,--version-script=', exports, ' ', strjoin(objects, ' '), ' ', ...
     strjoin(archives, ' '), ' -L', set.outdir, ' -Wl,-rpath,', set.outdir, ' ', set.LINKLIBS, ' -o ', ...
     fullfile(set.outdir, [set.output, '.mex'])]);
end

function run(command)
[status, text] = system([command, ' 2>&1']);
assert(status == 0, '%s: %s', command, text);
end

function write(path, text)
file = fopen(path, 'w');
fprintf(file, '%s\n', text);
fclose(file);
end
