#!/usr/bin/env bash
# SPDX-License-Identifier: Apache-2.0
# Starts the program as systemd would, uses its service, stops it, and looks at what it logged.
#   hosted_test.sh PROGRAM_FOLDER ROBDEF
set -euo pipefail
program=$1/hosted.dll robdef=$2
work=$(mktemp -d)
trap 'kill -9 $running 2>/dev/null || true; rm -rf "$work"' EXIT
fail() {
  echo "hosted_test: $*" >&2
  cat "$work/log" >&2
  exit 1
}
logged() { grep -q -- "$1" "$work/log"; }

export DOTNET_NOLOGO=1
# Another name than the default, from the command line, which the host's configuration reads.
dotnet "$program" --Robdef:Urls:0=rr+tcp://localhost:0 --Robdef:Name=lab.host >"$work/log" 2>&1 &
running=$!
for _ in $(seq 600); do
  logged 'Service at ' && break
  kill -0 $running 2>/dev/null || fail 'the program has ended'
  sleep 0.1
done
url=$(sed -n 's/.*Service at \(rr+tcp:[^ ]*\).*/\1/p' "$work/log")
[ -n "$url" ] || fail 'no service was offered'

"$robdef" set "$url" level 0.25
[ "$("$robdef" get "$url" level)" = 0.25 ] || fail 'the level is another one'
! "$robdef" set "$url" level 2 2>"$work/refusal" || fail 'a level of 2 was taken'
grep -q 'a level is from 0 to 1, not 2' "$work/refusal" || { cat "$work/refusal" >&2; fail 'the refusal does not say why'; }
"$robdef" call "$url" blink 2 0.1

kill -TERM $running
wait $running || fail "the program has ended with status $?"
for line in 'The lamp is at 0.25' 'The lamp is at 0.75' \
  'Span lab.lamp.Lamp/level Unset' 'Span lab.lamp.Lamp/level Error' 'Span lab.lamp.Lamp/blink Unset' \
  'Measured rpc.server.call.duration lab.lamp.Lamp/blink call: 1 times' \
  'Measured rpc.server.call.duration lab.lamp.Lamp/level get: 1 times' \
  'Measured rpc.server.call.duration lab.lamp.Lamp/level set: 1 times' \
  'Measured rpc.server.call.duration lab.lamp.Lamp/level set RobotRaconteur.InvalidArgument: 1 times' \
  'Sessions now: 0'; do
  logged "$line" || fail "not logged: $line"
done
# Two blinks wait for half a period four times.
milliseconds=$(sed -n 's/.*blink call: 1 times, \([0-9]*\)\..*/\1/p' "$work/log")
[ "$milliseconds" -ge 200 ] || fail "blinking took $milliseconds ms"
echo 'hosted_test: passed'
