#!/usr/bin/env bash
# SPDX-License-Identifier: Apache-2.0
# What the interpreter lives through, each case in a process of its own: interrupts, `clear all` and
# `exit` in every state, killed services, loads and unloads.
# Usage: interpreter_test.sh SERVICE OCTAVE TOOLBOX
set -euo pipefail

service_program=$1
octave=$2
toolbox=$3
folder=$(cd "$(dirname "$0")" && pwd)
work=$(mktemp -d)
service=
trap '[ -z "$service" ] || kill "$service" 2>/dev/null || true; rm -rf "$work"' EXIT

"$service_program" --port 0 --seconds 110 > "$work/service" &
service=$!
for _ in $(seq 100); do
  [ -e "$work/service" ] && grep -q '^ready: ' "$work/service" && break
  sleep 0.1
done
RR_TEST_PORT=$(sed -n 's/^ready: //p' "$work/service")
export RR_TEST_PORT RR_TEST_SERVICE=$service_program RR_TEST_FOLDER=$work

# expect NAME STATUS PATTERN CODE: what Octave ends with, and a line of what it says.
expect() {
  local name=$1 wanted=$2 pattern=$3 code=$4 status=0
  timeout 60 "$octave" --norc --path "$toolbox" --path "$folder" --eval "$code" \
    > "$work/output" 2>&1 || status=$?
  if [ "$status" != "$wanted" ] || ! grep -q -- "$pattern" "$work/output"; then
    echo "FAILED: $name: ended with $status, and said:"
    cat "$work/output"
    exit 1
  fi
  echo "passed: $name"
}

# Ctrl-C in whatever blocks: an error that says so, at once, and the interpreter goes on.
interrupt='function interrupt(), system(sprintf("sleep 0.3; kill -INT %d", getpid()), false, "async"); end;
c = rr_bench(); other = rr_bench(); interrupt(); start = tic();'
check='assert(toc(start) < 10); assert(other.add(1, 2), int32(3)); disp("went on")'
while IFS='|' read -r name code; do
  expect "interrupted: $name" 0 'went on' "$interrupt
    try, $code, catch err, assert(err.identifier, 'RobotRaconteur:OperationCancelled');
    assert(strncmp(err.message, 'interrupted', 11)); end; $check"
done <<'CASES'
a call|c.nap(15);
a call with a callback set|c.advise = @(x) x; c.nap(15);
Poll|RobotRaconteur.Poll(30);
a wire|c.get_tool().level.Connect().WaitInValueValid(30);
a pipe|c.numbers.Connect().ReceivePacketWait(30);
a subscription|RobotRaconteur.SubscribeService('rr+tcp://127.0.0.1:1/?service=x').GetDefaultClientWait(30);
a monitor|RobotRaconteur.MonitorEnter(other); RobotRaconteur.MonitorEnter(c);
Sleep|RobotRaconteur.Sleep(30);
CASES

# Everything that there can be, left as it is.
everything='c = rr_bench(); t = c.get_tool(); w = c.level.Connect(); p = c.numbers.Connect();
g = c.count(5); g.Next(); c.advise = @(x) t.question(x); l = addlistener(c, "fired", @(n, s) c.add(n, 1));
m = addlistener(w, "WireValueChanged", @(v, time) t.say("x")); c.async_nap(0.2, @(varargin) c.stop());
s = RobotRaconteur.SubscribeService(["rr+tcp://127.0.0.1:", getenv("RR_TEST_PORT"), "/?service=bench"]);
d = s.GetDefaultClientWait(20); sw = s.SubscribeWire("level"); global kept; kept = {c, t}; c.fire(3);'
expect 'the end of a program' 0 'said' "$everything disp('said')"
expect 'exit' 5 'said' "$everything disp('said'); exit(5)"
expect 'an error' 1 'some error' "$everything error('some error')"
expect 'exit in a handler' 7 'said' \
  "c = rr_bench(); l = addlistener(c, 'fired', @(n, s) exit(7)); disp('said'); c.fire(1); RobotRaconteur.Poll(20);"
expect 'exit in a callback' 8 'said' "c = rr_bench(); c.advise = @(x) exit(8); disp('said'); c.consult(1);"
expect 'clear all' 0 'went on' \
  "$everything clear all; c = rr_bench(); assert(c.add(1, 2), int32(3)); disp('went on')"
expect 'clear all, then Shutdown' 0 'went on' \
  "$everything clear all; RobotRaconteur.Shutdown(); c = rr_bench(); c.stop(); disp('went on')"
expect 'Shutdown, then what was before' 0 'went on' "$everything RobotRaconteur.Shutdown();
  try, c.stop(); catch err, assert(err.identifier, 'RobotRaconteur:InvalidOperation'); end
  c = rr_bench(); c.stop(); clear t w p g; c.stop(); disp('went on')"
expect 'Shutdown in a handler' 0 'a handler cannot shut the node down' \
  "c = rr_bench(); l = addlistener(c, 'fired', @(n, s) RobotRaconteur.Shutdown()); c.fire(1);
  RobotRaconteur.Poll(20); c.stop();"
expect 'clear all in a handler' 0 'went on' "c = rr_bench();
  l = addlistener(c, 'fired', @(n, s) evalin('base', 'clear all')); c.fire(1); RobotRaconteur.Poll(20);
  c = rr_bench(); c.stop(); disp('went on')"
expect 'DisconnectService in a callback' 0 'went on' "c = rr_bench();
  c.advise = @(x) RobotRaconteur.DisconnectService(c);
  try, c.consult(1); catch err, assert(strncmp(err.identifier, 'RobotRaconteur:', 15)); end
  c = rr_bench(); c.stop(); disp('went on')"

expect '1,000 loads and unloads' 0 'went on' "for i = 1:1000
    rrmex('now'); assert(mislocked('rrmex')); RobotRaconteur.Shutdown(); clear -f rrmex; end
  c = rr_bench(); assert(c.add(1, 2), int32(3)); disp('went on')"
expect '100 loads and unloads with connections' 0 'went on' "for i = 1:100
    c = rr_bench(); c.advise = @(x) x; assert(c.consult(i), i); RobotRaconteur.Shutdown(); clear all; end
  disp('went on')"

# Last: it takes the service with it.
expect 'a killed service' 0 'went on' "c = rr_bench(); w = c.level.Connect(); p = c.numbers.Connect();
  g = c.count(2); s = rr_bench();
  try, s.crash(); error('not thrown'); catch err, assert(err.identifier, 'RobotRaconteur:ConnectionError'); end
  assert(rr_eventually(@() ~w.IsOpen && ~p.IsOpen));
  for f = {@() c.add(1, 2), @() g.Next(), @() p.ReceivePacketWait(1), @() c.level.Connect(), @() c.get_tool()}
    try, f{1}(); error('not thrown'); catch err, assert(strncmp(err.identifier, 'RobotRaconteur:', 15)); end
  end
  disp('went on')"
echo 'all passed'
