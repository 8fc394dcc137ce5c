#!/usr/bin/env bash
# SPDX-License-Identifier: Apache-2.0
# Runs the service on a free port and the paper's session in Octave against it, and looks at what it
# says and at the picture. Usage: end_to_end_test.sh SERVICE OCTAVE TOOLBOX
set -euo pipefail

folder=$(cd "$(dirname "$0")" && pwd)
work=$(mktemp -d)
service=
trap '[ -z "$service" ] || kill "$service" 2>/dev/null || true; rm -rf "$work"' EXIT

"$1" --port 0 --seconds 50 > "$work/service" &
service=$!
for _ in $(seq 100); do
  [ -e "$work/service" ] && grep -q '^ready: ' "$work/service" && break
  sleep 0.1
done
# A program for Windows ends its lines otherwise.
url=$(tr -d '\r' <"$work/service" | sed -n 's/^ready: //p')

"$2" --norc --path "$3" --path "$folder" \
  --eval "smart_room_client('$url', '$work/room.png')" | tee "$work/client"
grep -q '2 devices, 4 cameras' "$work/client"
grep -q 'device 0 is `RGB lights`, camera 0 is `ceiling camera 0`' "$work/client"
grep -q 'lamps 1 and 2 are at 0.7 0.3 0.0' "$work/client"
grep -q '^[1-9][0-9]* % of the pixels have changed' "$work/client"
grep -q 'lamp 99 is refused by the service: RobotRaconteur:InvalidArgument: lamps are counted from 1 to 6' "$work/client"
grep -q 'a picture of 320 x 240 pixels' "$work/client"
# What the file shows is what was set: red over green over blue below the lamps.
"$2" --norc --eval "I = double(imread('$work/room.png')); assert(size(I), [240 320 3]);
  m = squeeze(max(max(I, [], 1), [], 2)); assert(m(1) > m(3));"
kill -TERM "$service"
wait "$service" || [ -n "${WINEPREFIX:-}" ]  # in wine a signal ends it without a word
service=
echo 'smart room in Octave: passed'
