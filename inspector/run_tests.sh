#!/usr/bin/env bash
# SPDX-License-Identifier: Apache-2.0
# run_tests.sh FOLDER: runs the tests that build.sh has compiled in FOLDER, but those in a browser.
set -euo pipefail
cd "$1/inspector/dist-test"
exec node --test ./*.test.mjs
