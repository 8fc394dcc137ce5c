#!/usr/bin/env bash
# SPDX-License-Identifier: Apache-2.0
# Runs the service on a free port and the client against it, and looks at what the client says and at
# the picture it writes. Usage: end_to_end_test.sh SERVICE CLIENT
set -euo pipefail

work=$(mktemp -d)
service=
trap '[ -z "$service" ] || kill "$service" 2>/dev/null || true; rm -rf "$work"' EXIT

"$1" --port 0 --seconds 50 > "$work/service" &
service=$!
for _ in $(seq 100); do
  grep -q '^ready: ' "$work/service" && break
  sleep 0.1
done
# A program for Windows ends its lines otherwise.
url=$(tr -d '\r' <"$work/service" | sed -n 's/^ready: //p')

"$2" "$url" --picture "$work/room.png" | tee "$work/client"
grep -q '2 devices, 4 cameras' "$work/client"
grep -q 'device 0 is `RGB lights`, device 1 is `RGB sensors`' "$work/client"
grep -q 'a picture of 320 x 240 pixels' "$work/client"
grep -q 'lamp 99 is refused by the service: RobotRaconteur.InvalidArgument: lamps are counted from 1 to 6' "$work/client"
# The lamps were set: what the first sensor saw was gray, and is not any more.
[ "$(sed -n '/^sensors before/,/ 0 /p' "$work/client" | grep -c 'red 0.\([0-9]*\)  green 0.\1')" = 1 ]
[ "$(sed -n '/^sensors after/,/ 0 /p' "$work/client" | grep -c 'red 0.\([0-9]*\)  green 0.\1')" = 0 ]
[ "$(head -c 8 "$work/room.png" | od -An -tx1 | tr -d ' ')" = 89504e470d0a1a0a ]

kill -TERM "$service"
wait "$service" || [ -n "${WINEPREFIX:-}" ]  # in wine a signal ends it without a word
service=
echo 'smart room: passed'
