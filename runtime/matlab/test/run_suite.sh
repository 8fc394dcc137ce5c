#!/usr/bin/env bash
# SPDX-License-Identifier: Apache-2.0
# Runs a suite of Octave's tests against the test service on a free port.
# Usage: run_suite.sh SERVICE OCTAVE TOOLBOX SUITE.m [FOLDER...]
# Functions in the folders come before the toolbox; with folders the suite is run on generated classes.
set -euo pipefail

folder=$(dirname "$4")
source "$(dirname "$0")/with_service.sh"
start_service "$1"
export RR_TEST_FILES=$folder
paths=()
for before in "${@:5}"; do
  paths+=(--path "$before")
  export RR_TEST_CLASSES=1
done
paths+=(--path "$3" --path "$folder")
"$2" --norc "${paths[@]}" --eval "rr_run_suite('$4', '$work/log')"
