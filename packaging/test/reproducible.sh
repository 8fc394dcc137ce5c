#!/usr/bin/env bash
# SPDX-License-Identifier: Apache-2.0
# Makes all packages twice and compares the bytes; lintian has nothing to say. What is built is built once.
# Usage: reproducible.sh SOURCE OUT: the packages are left in OUT
set -euo pipefail
source=$1 out=$2
again=$out.again
fail() { echo "reproducible: $*" >&2; exit 1; }
# Tests run on trees with changes, too.
export ROBDEF_PACKAGE_DIRTY=1
rm -rf "$out" "$again"
"$source/tools/package" "$out"
"$source/tools/package" "$again"
for file in "$out"/*; do
  cmp "$file" "$again/$(basename "$file")" || fail "$(basename "$file") is another one the second time"
done
[ "$(ls "$out" | wc -l)" = "$(ls "$again" | wc -l)" ] || fail 'the second time there are other files'
rm -rf "$again"
lintian --allow-root --display-info --pedantic "$out"/*.deb >"$out/lintian.txt" 2>&1 ||
  { cat "$out/lintian.txt" >&2; fail 'lintian has found something'; }
cat "$out/lintian.txt"
! grep -E '^[EW]:' "$out/lintian.txt" || fail 'lintian has found something'
for package in "$out"/*.deb; do
  dpkg-deb --contents "$package" >"$out/$(basename "$package" .deb).contents.txt"
done
echo 'reproducible: passed'
