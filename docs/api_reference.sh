#!/usr/bin/env bash
# SPDX-License-Identifier: Apache-2.0
# Makes the API reference with doxygen in FOLDER/api, and says how many public names have no documentation; the list is in
# FOLDER/api/undocumented.txt. Usage: api_reference.sh FOLDER
set -euo pipefail
[ $# = 1 ] || { echo "usage: api_reference.sh FOLDER" >&2; exit 2; }
mkdir -p "$1"
folder=$(cd "$1" && pwd)
cd "$(dirname "$0")/.."
warnings=$(mktemp)
trap 'rm -f "$warnings"' EXIT
{
  cat docs/Doxyfile
  echo "OUTPUT_DIRECTORY = $folder"
  echo "WARN_LOGFILE = $warnings"
} | doxygen -
sed "s#^$PWD/##" "$warnings" | sort -u >"$folder/api/undocumented.txt"
echo "API reference: $(grep -c 'is not documented' "$folder/api/undocumented.txt" || true) public names without documentation," \
  "$(grep -vc 'is not documented' "$folder/api/undocumented.txt" || true) other warnings"
