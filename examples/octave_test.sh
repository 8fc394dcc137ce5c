#!/usr/bin/env bash
# SPDX-License-Identifier: Apache-2.0
# Runs an example's session in Octave and looks at what it prints, by regular expressions, and at
# the picture, by a condition in Octave's language on its pixels `I`.
# Usage: octave_test.sh OCTAVE TOOLBOX FUNCTION.m PROGRAM CONDITION EXPRESSION...
set -euo pipefail
octave=$1
condition=$5
work=$(mktemp -d)
trap 'rm -rf "$work"' EXIT
"$(dirname "$0")/octave_session.sh" "$octave" "$2" "$3" "$work/picture.png" "$4" --serve 100 |
  tee "$work/says"
for expression in "${@:6}"; do
  grep -qE -- "$expression" "$work/says" || { echo "not said: $expression" >&2; exit 1; }
done
"$octave" --norc --eval "I = double(imread('$work/picture.png')); assert($condition);"
