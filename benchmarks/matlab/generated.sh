#!/usr/bin/env bash
# SPDX-License-Identifier: Apache-2.0
# What a call costs from Octave: the dynamic object, a generated class by name, and a generated class
# with its stubs compiled in, each in an interpreter of its own, against the same service on loopback.
# Usage: generated.sh [BUILD]    (build/release by default; built by `ninja robdef_matlab`)
set -euo pipefail
here=$(cd "$(dirname "$0")" && pwd)
build=$(cd "${1:-build/release}" && pwd)
toolbox=$build/matlab
classes=$build/runtime/matlab/test/generated/robdef_bench_classes_robdef
work=$(mktemp -d)
service=
trap '[ -z "$service" ] || kill "$service" 2>/dev/null || true; rm -rf "$work"' EXIT

"$build/tests/matlab_test_service" --port 0 --seconds 300 > "$work/service" &
service=$!
for _ in $(seq 100); do
  grep -q '^ready: ' "$work/service" && break
  sleep 0.1
done
url="rr+tcp://127.0.0.1:$(sed -n 's/^ready: //p' "$work/service")/?service=bench"

# measure WHAT CONSTRUCTOR FOLDER...: the first folder comes first in the path.
measure() {
  local what=$1 constructor=$2 paths=()
  shift 2
  for folder in "$@"; do paths+=(--path "$folder"); done
  octave-cli --norc "${paths[@]}" --path "$here" --eval "calls('$what', @$constructor, '$url')"
}

printf '%-26s %9s %9s %9s %9s %9s\n' 'microseconds, least' get set add struct '10^5 dbl'
measure 'dynamic object' RobotRaconteur.ConnectService "$toolbox"
measure 'class, by name' experimental.bench.Bench "$toolbox" "$classes"
measure 'class, stubs compiled in' experimental.bench.Bench "$classes" "$toolbox"
