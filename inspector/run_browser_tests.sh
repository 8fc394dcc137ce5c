#!/usr/bin/env bash
# SPDX-License-Identifier: Apache-2.0
# run_browser_tests.sh FOLDER [PROGRAMS]: runs the tests in Chromium that build.sh has compiled in FOLDER, one file after the
# other. PROGRAMS: folder of the examples in C++. Exit status 77: there is no Chromium.
set -euo pipefail
if ! command -v "${ROBDEF_BROWSER:-chromium}" >/dev/null; then
  echo "Chromium is not installed (apt-get install chromium): the tests of the page in it are left out"
  exit 77
fi
cd "$1/inspector/dist-test"
export ROBDEF_PROGRAMS=${2:-}
for file in *.browser.mjs; do
  echo "# $file"
  node "$file"
done
