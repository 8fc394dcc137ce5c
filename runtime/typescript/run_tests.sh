#!/usr/bin/env bash
# SPDX-License-Identifier: Apache-2.0
# run_tests.sh FOLDER: runs the tests that build.sh has compiled in FOLDER.
set -euo pipefail
cd "$1/runtime/typescript/dist-test/test"
exec node --test ./*.test.js
