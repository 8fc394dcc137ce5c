#!/usr/bin/env bash
# SPDX-License-Identifier: Apache-2.0
# Holds pages that name tests, programs and files to what there is. Usage: check_names.sh ROOT PAGE...
set -euo pipefail
root=$1
shift
cd "$root"
tests=$(grep -rhozE 'TEST(_F|_P)?\(\s*\w+,\s*\w+\)' --include='*_test.cpp' cli compiler runtime conformance examples |
  tr '\n\0' ' \n' | sed -E 's/.*\(\s*(\w+),\s*(\w+)\)/\1.\2/' | sort -u)
status=0
complain() {
  echo "$1: there is no $2" >&2
  status=1
}
for page in "$@"; do
  quoted=$(grep -oE '`[^`]+`' "$page" | tr -d '`' | sort -u)
  while read -r name; do
    case $name in
      build/release/*)  # a program
        program=$(basename "${name%% *}")
        # By its name, or as one of several: `smart_room_${program}`.
        grep -rqE "((add_executable|robdef_test)\(|OUTPUT_NAME )(${program}([ )]|$)|${program%_*}_[$])" --include=CMakeLists.txt \
          cli compiler runtime conformance examples || complain "$page" "program $program"
        ;;
      docs/* | runtime/* | examples/* | cli/* | compiler/* | benchmarks/* | conformance/* | rr/*)  # a file
        file=${name%% *}
        [ -e "$file" ] || [ -e "runtime/cpp/include/$file" ] || compgen -G "$file" >/dev/null ||
          compgen -G "runtime/cpp/include/$file" >/dev/null || complain "$page" "file $file"
        ;;
      *)
        [[ $name =~ ^([A-Za-z]+/)?([A-Z][A-Za-z]+)\.([A-Z][A-Za-z]+|\*)$ ]] || continue
        grep -qE "^${BASH_REMATCH[2]}\.${BASH_REMATCH[3]/\*/}" <<<"$tests" || complain "$page" "test $name"
        ;;
    esac
  done <<<"$quoted"
done
exit $status
