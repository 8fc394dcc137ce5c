#!/usr/bin/env bash
# SPDX-License-Identifier: Apache-2.0
# Runs an example twice: both say the same, the wanted text too, and write the same picture.
# Usage: end_to_end.sh PROGRAM TEXT
set -euo pipefail
work=$(mktemp -d)
trap 'rm -rf "$work"' EXIT
cd "$work"
"$1" --picture picture.png | tee first
mv picture.png first.png
"$1" --picture picture.png > second
cmp first second
cmp first.png picture.png
grep -qF -- "$2" first
[ "$(head -c 8 picture.png | od -An -tx1 | tr -d ' ')" = 89504e470d0a1a0a ]
