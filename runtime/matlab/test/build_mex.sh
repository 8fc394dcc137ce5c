#!/usr/bin/env bash
# SPDX-License-Identifier: Apache-2.0
# Builds the toolbox with build_mex.m, and reads a property with it.
# Usage: build_mex.sh BUILD [OCTAVE [sources]]: from the library of the build, or from all sources, as
# MATLAB does: two minutes.
set -euo pipefail
build=$(cd "$1" && pwd)
octave=${2:-octave-cli}
from_sources=$([ "${3:-}" = sources ] && echo true || echo false)
here=$(cd "$(dirname "$0")" && pwd)
source "$here/with_service.sh"
cd "$work"
"$octave" --norc --path "$here/.." --eval "build_mex('$build', '$work/toolbox', $from_sources)"
# The service does not wait for a slow compiler.
start_service "$build/tests/matlab_test_service"
"$octave" --norc --path "$work/toolbox" --path "$here" --eval "
  assert(which('rrmex'), '$work/toolbox/rrmex.mex');
  c = rr_bench();
  assert(c.fixed, int32(17));
  c.v_double = 2.5;
  assert(c.v_double, 2.5);"
echo "built with build_mex, and used"
