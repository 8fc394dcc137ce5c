#!/usr/bin/env bash
# SPDX-License-Identifier: Apache-2.0
# Runs a suite of Octave's tests against the test service on a free port.
# Usage: run_suite.sh SERVICE OCTAVE TOOLBOX SUITE.m [FOLDER...]
# Functions in the folders come before the toolbox; with folders the suite is run on generated classes.
set -euo pipefail

work=$(mktemp -d)
service=
trap '[ -z "$service" ] || kill "$service" 2>/dev/null || true; rm -rf "$work"' EXIT

"$1" --port 0 --seconds 110 > "$work/service" &
service=$!
for _ in $(seq 100); do
  [ -e "$work/service" ] && grep -q '^ready: ' "$work/service" && break
  sleep 0.1
done
RR_TEST_PORT=$(sed -n 's/^ready: //p' "$work/service")
export RR_TEST_PORT
export RR_TEST_SERVICE=$1
export RR_TEST_FOLDER=$work
folder=$(dirname "$4")
paths=()
for before in "${@:5}"; do
  paths+=(--path "$before")
  export RR_TEST_CLASSES=1
done
paths+=(--path "$3" --path "$folder")
"$2" --norc "${paths[@]}" --eval "rr_run_suite('$4', '$work/log')"
