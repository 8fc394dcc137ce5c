#!/usr/bin/env bash
# SPDX-License-Identifier: Apache-2.0
# As a user does it: installs a build, generates classes with the installed compiler, builds their MEX
# file with the function that stands beside them, and uses a service with it.
# Usage: build_function.sh BUILD [OCTAVE]
set -euo pipefail
build=$(cd "$1" && pwd)
octave=${2:-octave-cli}
here=$(cd "$(dirname "$0")" && pwd)
source "$here/../with_service.sh"
start_service "$build/tests/matlab_test_service"

cmake --install "$build" --prefix "$work/installed" > "$work/install.log"
"$work/installed/bin/robdef" generate --lang matlab -o "$work/classes" "$here/../experimental.bench.robdef"
toolbox=$work/installed/share/robdef/matlab
cd "$work/classes"
"$octave" --norc --path "$toolbox" --eval "build_experimental_bench_client('$work/installed', '-O0')"
# From elsewhere: nothing of the build is beside it.
cd "$work"
"$octave" --norc --path "$work/classes" --path "$toolbox" --eval "
  assert(which('rrmex'), '$work/classes/rrmex.mex');
  r = experimental.bench.Report('count', 3);
  c = experimental.bench.Bench('rr+tcp://127.0.0.1:$RR_TEST_PORT/?service=bench');
  assert(c.fixed, int32(17));
  c.report = r;
  assert(c.report.count, int32(3));
  assert(c.get_tool().say('x'), 'the tool: x');"
echo "built with the function beside the classes, and used"
