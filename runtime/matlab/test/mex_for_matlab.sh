#!/usr/bin/env bash
# SPDX-License-Identifier: Apache-2.0
# Builds the MEX file as MATLAB does, with a stand-in for its function mex, and shows that it stands on none
# of the libraries that MATLAB has in other versions: by its names, and by using it beside an OpenSSL whose
# every function aborts.
# Usage: mex_for_matlab.sh BUILD OCTAVE COMPILER HEADERS: HEADERS is the folder of Octave's mex.h.
set -euo pipefail
build=$(cd "$1" && pwd)
octave=$2
here=$(cd "$(dirname "$0")" && pwd)
source "$here/with_service.sh"
export RR_TEST_FOLDER=$work RR_TEST_HEADERS=$4
export RR_TEST_COMPILER="$(command -v ccache || true) $3"
# Of another folder, what is compiled is the same for ccache.
export CCACHE_BASEDIR=$work
"$octave" --norc --path "$here/.." --path "$here/mex_for_matlab" \
  --eval "build_mex('$build', '$work/toolbox', true, true)"
file=$work/toolbox/rrmex.mex
# The service does not wait for a slow compiler.
start_service "$build/tests/matlab_test_service"

fail() {
  echo "FAILED: $1"
  shift
  printf '%s\n' "$@"
  exit 1
}

# Names: what is defined and seen is the function of a MEX file; what is missing is the interpreter's and
# the C library's. The weak ones are of the compiler's own start and of transactional memory.
defined=$(nm -D --defined-only "$file" | awk '{ print $3 }')
[ "$defined" = mexFunction ] || fail 'more than the function of a MEX file is exported' "$defined"
missing=$(nm -D --undefined-only "$file" | awk '{ print $NF }' |
  grep -vE '^(mx|mex)[A-Z]|^utIsInterruptPending$|@GLIBC_[0-9.]+(\(|$)|^_ITM_|^_ZGTt|^__gmon_start__$' || true)
[ -z "$missing" ] || fail 'names come from other libraries' "$missing"
needed=$(readelf -d "$file" | sed -n 's/.*NEEDED.*\[\(.*\)\]/\1/p' | grep -vE '^(libut|libm|libc|ld-linux.*)\.so' || true)
[ -z "$needed" ] || fail 'other libraries are needed' "$needed"

# Each function of OpenSSL that the runtime uses, as a function that aborts; before all other libraries.
nm -D --undefined-only "$build/matlab/rrmex.mex" | awk '{ print $NF }' | sed -n 's/@OPENSSL_.*//p' | sort -u \
  >"$work/names"
[ "$(wc -l <"$work/names")" -gt 50 ] || fail 'the names of OpenSSL were not found' "$(cat "$work/names")"
{
  echo '#include <stdio.h>'
  echo '#include <stdlib.h>'
  sed 's/.*/void &(void) { fputs("the other OpenSSL: &\\n", stderr); abort(); }/' "$work/names"
} >"$work/other.c"
cc -shared -fPIC -o "$work/other.so" "$work/other.c"
# Only TLS needs OpenSSL; that nobody speaks it there comes later than its first calls.
use="try, RobotRaconteur.ConnectService(['rr+wss://127.0.0.1:', getenv('RR_TEST_PORT'), '/?service=bench']);
    error('served'); catch err, assert(~strcmp(err.message, 'served')); end
  c = rr_bench('guarded', 'alice', 'open sesame'); assert(c.add(1, 2), int32(3));
  RobotRaconteur.SetLogLevel('ERROR'); disp('used')"
beside() { LD_PRELOAD=$work/other.so "$octave" --norc --path "$1" --path "$here" --eval "$use"; }
said=$(beside "$work/toolbox" 2>&1) || fail 'the file for MATLAB calls another OpenSSL' "$said"
[ "$said" = used ] || fail 'the file for MATLAB says more' "$said"
# The file for Octave is linked with the system's; that this test sees the difference is shown by it.
if said=$(beside "$build/matlab" 2>&1) || ! grep -q 'the other OpenSSL' <<<"$said"; then
  fail 'the other OpenSSL is not called by a file that is linked with it' "$said"
fi

# As a whole: what it does with members, types and streams.
for suite in object types streams usage; do
  "$here/run_suite.sh" "$build/tests/matlab_test_service" "$octave" "$work/toolbox" "$here/${suite}_test.m"
done
echo 'built as MATLAB does, and used'
