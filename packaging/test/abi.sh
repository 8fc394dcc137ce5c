#!/usr/bin/env bash
# SPDX-License-Identifier: Apache-2.0
# Compares the names that shared libraries offer with those of the last release, by abidiff; and shows that a name that is
# missing would be found. The baselines have the names alone: libraries of a release have no debugging information.
# docs/decisions/0033-shared-libraries.md.
# Usage: abi.sh LIBRARIES BASELINES COMPILER [--update]
#   LIBRARIES has librobdef.so, librobdef.a and the others; --update writes the baselines, for a release
set -euo pipefail
libraries=$1 baselines=$2 compiler=$3
here=$(cd "$(dirname "$0")" && pwd)
map=$here/../../runtime/cpp/shared/exports.map
work=$(mktemp -d)
trap 'rm -rf "$work"' EXIT
fail() { echo "abi: $*" >&2; exit 1; }
names='librobdef librobdef_tls librobdef_web librobdef_realtime librobdef_dynamic librobdef_serial librobdef_c'
library() { find "$libraries" -name "$1.so" -print -quit; }

if [ "${4:-}" = --update ]; then
  for name in $names; do
    # Where it was built is nothing of the interface, nor where in the file a name stands.
    abidw --no-corpus-path --no-comp-dir-path "$(library "$name")" | gzip -9n >"$baselines/$name.abi.gz"
  done
  ls -l "$baselines"
  exit
fi

# compare NAME FILE: status 0 when nothing is missing and nothing has changed
compare() {
  gzip -dc "$baselines/$1.abi.gz" >"$work/$1.abi"
  abidiff --no-added-syms --suppressions "$baselines/inside.suppr" "$work/$1.abi" "$2"
}
for name in $names; do
  compare "$name" "$(library "$name")" >"$work/said" || { cat "$work/said" >&2; fail "$name: the interface of the last release is not kept"; }
  echo "abi: $name: $(grep -c '<elf-symbol' "$work/$name.abi") names, none is missing"
done

# The same objects without one function: hidden by its exact name, which comes before all patterns.
lost=_ZN2rr4Node6listenESt17basic_string_viewIcSt11char_traitsIcEE
# All is read: a reader that leaves early would end nm by a signal.
nm -D --defined-only "$(library librobdef)" | grep " $lost@" >/dev/null || fail "$lost is no name of librobdef"
sed "s/  local: \*;/  local: $lost; *;/" "$map" >"$work/cut.map"
"$compiler" -shared -o "$work/librobdef.so" -Wl,-soname,librobdef.so.1 -Wl,--version-script="$work/cut.map" \
  -Wl,--whole-archive "$(find "$libraries" -name librobdef.a -not -path '*arduino*' -print -quit)" -Wl,--no-whole-archive -pthread
status=0
compare librobdef "$work/librobdef.so" >"$work/said" || status=$?
# 8: the interface is broken; 4: it has changed.
[ $((status & 8)) != 0 ] || { cat "$work/said" >&2; fail "a function that is missing gives status $status"; }
grep -qF "$lost" "$work/said" || { cat "$work/said" >&2; fail 'what is missing is not named'; }
grep -F "$lost" "$work/said"
echo 'abi: passed'
