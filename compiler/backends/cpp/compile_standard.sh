#!/bin/sh
# SPDX-License-Identifier: Apache-2.0
# Generates C++ for all standard definitions but the one that the language refuses, and compiles it
# with warnings as errors. A few sources at a time make one unit, which saves most of the work.
#   compile_standard.sh ROBDEF COMPILER RUNTIME_INCLUDES SCRATCH STANDARD_DIR
set -eu
robdef=$1 compiler=$2 includes=$3 scratch=$4 standard=$5

rm -rf "$scratch"
mkdir -p "$scratch/units"
refused=com.robotraconteur.a1.robotics.planning.robdef
if "$robdef" check -I "$standard" "$standard/$refused" 2>"$scratch/refused.txt"; then
  echo "$refused was accepted" >&2
  exit 1
fi
files=$(find "$standard" -name '*.robdef' ! -name "$refused" | sort)
# shellcheck disable=SC2086  # a list of paths without blanks
"$robdef" generate --lang cpp -o "$scratch/cpp" $files 2>"$scratch/findings.txt"

cd "$scratch/cpp"
find . -name '*.cpp' | sort >../sources.txt
expected=$(echo "$files" | wc -l)
found=$(wc -l <../sources.txt)
if [ "$found" -ne "$expected" ] || [ "$found" -eq 0 ]; then
  echo "$expected definitions, but $found sources" >&2
  exit 1
fi
split -l 6 ../sources.txt ../units/unit.
for unit in ../units/unit.*; do
  sed 's|^\./\(.*\)$|#include "\1"|' "$unit" >"$unit.cpp"
  echo "$unit.cpp"
done | xargs -P 2 -n 1 "$compiler" -std=c++20 -fsyntax-only \
  -Wall -Wextra -Wpedantic -Wshadow -Wconversion -Werror -I . -I "$includes"
echo "$found definitions compiled with $compiler"
