#!/usr/bin/env bash
# SPDX-License-Identifier: Apache-2.0
# Starts a program that serves and prints `ready: URL`, and calls a function in Octave with that URL
# and the name of a picture. Fails when one of the two does; leaves nothing running.
# Usage: octave_session.sh OCTAVE TOOLBOX FUNCTION.m PICTURE PROGRAM [ARGUMENT...]
set -euo pipefail
octave=$1
toolbox=$2
folder=$(dirname "$3")
function=$(basename "$3" .m)
picture=$4
shift 4

work=$(mktemp -d)
service=
trap '[ -z "$service" ] || kill "$service" 2>/dev/null || true; rm -rf "$work"' EXIT
mkfifo "$work/says"
"$@" > "$work/says" &
service=$!
exec 3< "$work/says"
url=
while read -r word url <&3; do
  [ "$word" != ready: ] || break
done
[ -n "$url" ] || { echo "$1 does not serve" >&2; exit 1; }
"$octave" --norc --path "$toolbox" --path "$folder" \
  --path "$(dirname "${BASH_SOURCE[0]}")/drawing/matlab" --eval "$function('$url', '$picture')"
kill -TERM "$service"
wait "$service"
service=
