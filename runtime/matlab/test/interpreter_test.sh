#!/usr/bin/env bash
# SPDX-License-Identifier: Apache-2.0
# What the interpreter lives through, each case in a process of its own: signals, `clear all` and
# `exit` in every state, killed services, loads and unloads.
# Usage: interpreter_test.sh SERVICE OCTAVE TOOLBOX [FOLDER...]
# Functions in the folders come before the toolbox: generated classes.
set -euo pipefail

octave=$2
folder=$(cd "$(dirname "$0")" && pwd)
paths=()
for before in "${@:4}"; do paths+=(--path "$before"); done
paths+=(--path "$3" --path "$folder")
source "$folder/with_service.sh"
start_service "$1"
export RR_TEST_FILES=$folder
cd "$work"

# expect NAME STATUS PATTERN CODE: what Octave ends with, and a line of what it says.
expect() {
  local name=$1 wanted=$2 pattern=$3 code=$4 status=0
  timeout -s KILL 180 "$octave" --norc "${paths[@]}" --eval "$code" > "$work/output" 2>&1 || status=$?
  if [ "$status" != "$wanted" ] || ! grep -q -- "$pattern" "$work/output"; then
    echo "FAILED: $name: ended with $status, and said:"
    cat "$work/output"
    exit 1
  fi
  echo "passed: $name"
}

# What blocks, each for longer than a test waits.
blocking=$(cat <<'CASES'
a call|c.nap(15);
a call with a callback set|c.advise = @(x) x; c.nap(15);
Poll|RobotRaconteur.Poll(30);
a wire|c.get_tool().level.Connect().WaitInValueValid(30);
a pipe|c.numbers.Connect().ReceivePacketWait(30);
a subscription|RobotRaconteur.SubscribeService('rr+tcp://127.0.0.1:1/?service=x').GetDefaultClientWait(30);
a monitor|RobotRaconteur.MonitorEnter(other); RobotRaconteur.MonitorEnter(c);
Sleep|RobotRaconteur.Sleep(30);
CASES
)
# Generated classes have calls of their own, and the rest in common with the dynamic object.
[ $# = 3 ] || blocking=$(head -n 2 <<< "$blocking")
sent='function sent(name)
  system(sprintf("\"%s/signal_when_idle.sh\" %s %d", getenv("RR_TEST_FILES"), name, getpid()), false, "async");
end;
c = rr_bench(); other = rr_bench();'

# Ctrl-C: an error that says so, at once, and the interpreter goes on.
check='assert(toc(start) < 10); assert(other.add(1, 2), int32(3)); disp("went on")'
while IFS='|' read -r name code; do
  expect "interrupted: $name" 0 'went on' "$sent sent('INT'); start = tic();
    try, $code error('not thrown'); catch err, assert(err.identifier, 'RobotRaconteur:OperationCancelled');
    assert(strncmp(err.message, 'interrupted', 11)); end; $check"
done <<< "$blocking"

# What ends Octave ends it in a call, too, at once, whatever errors the program catches.
ends() {
  local begin=$SECONDS
  expect "$1" 1 'caught signal .* -- stopping myself' "$2"
  [ $((SECONDS - begin)) -lt 12 ] || { echo "FAILED: $1: it ended too late"; exit 1; }
  if grep -q 'went on' "$work/output"; then
    echo "FAILED: $1: it went on first"
    exit 1
  fi
}
while IFS='|' read -r name code; do
  ends "SIGTERM: $name" "$sent sent('TERM'); try, $code catch err, disp(err), end; disp('went on')"
done <<< "$blocking"
ends 'SIGHUP: a call' "$sent sent('HUP'); try, c.nap(15); catch err, disp(err), end; disp('went on')"
ends 'SIGTERM in a handler that waits' "$sent
  l = addlistener(other, 'fired', @(n, s) c.nap(15)); sent('TERM'); other.fire(1);
  try, RobotRaconteur.Poll(20); catch err, disp(err), end; disp('went on')"
ends 'SIGTERM between calls' "$sent
  system(sprintf('sleep 0.3; kill -TERM %d; sleep 1', getpid()), false, 'async');
  try, while true, c.stop(); pause(0.01); end; catch err, disp(err), end; disp('went on')"
ends 'calls at the end' "$sent sent('TERM'); function last(), d = rr_bench(); d.v_double = d.add(40, 2); end;
  atexit('last'); c.nap(15); disp('went on')"
expect 'what the function at the end has done' 0 'it is 42' "c = rr_bench(); printf('it is %d\n', c.v_double)"
expect 'another signal does not end a call' 0 'went on' "c = rr_bench();
  system(sprintf('sleep 0.1; kill -USR1 %d', getpid()), false, 'async'); assert(c.nap(0.4), 0.4); disp('went on')"
expect 'a process that ends does not end a call' 0 'went on' "c = rr_bench();
  system('sleep 0.1', false, 'async'); assert(c.nap(0.4), 0.4); disp('went on')"
expect 'SIGTERM after Shutdown' 1 'stopping myself' "c = rr_bench(); RobotRaconteur.Shutdown(); clear c;
  kill(getpid(), 15); while true, pause(0.01); end"

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

# States in which everything is cleared, the node ended, or both; what comes after is as at first. The
# variables of a test go, too, so all states stand behind each other.
states=$(cat <<'STATES'
an object|c = rr_bench(); t = c.get_tool(); kept = {c, struct('t', t)};
a wire|c = rr_bench(); w = c.level.Connect(); c.show_level(1); w.OutValue = 2;
a wire with a handler|c = rr_bench(); w = c.level.Connect(); l = addlistener(w, 'WireValueChanged', @(v, t) c.stop()); c.show_level(2);
a pipe|c = rr_bench(); p = c.numbers.Connect(); p.SendPacket(1); l = addlistener(p, 'PacketReceived', @(x) c.stop()); c.send_numbers([1 2]);
a memory|c = rr_bench(); m = c.grid; x = m(:);
a generator|c = rr_bench(); g = c.count(5); g.Next();
a generator whose step is under way|c = rr_bench(); g = c.count(5); g.async_Next(@(varargin) c.stop());
an asynchronous call|c = rr_bench(); c.async_nap(0.5, @(varargin) error('late'), c);
an event that waits|c = rr_bench(); l = addlistener(c, 'fired', @(n, s) c.add(n, 1)); c.fire(3);
a callback|c = rr_bench(); c.advise = @(x) x + c.add(1, 1); assert(c.consult(1), 3);
an object lock|c = rr_bench('guarded', 'alice', struct('password', 'open sesame')); RobotRaconteur.RequestObjectLock(c, 'User');
a monitor|c = rr_bench(); RobotRaconteur.MonitorEnter(c, 20);
a subscription|s = RobotRaconteur.SubscribeService(rr_url()); d = s.GetDefaultClientWait(20); sw = s.SubscribeWire('level'); sp = s.SubscribePipe('numbers');
a subscription that cannot connect|s = RobotRaconteur.SubscribeService('rr+tcp://127.0.0.1:1/?service=x');
inside a handler of a subscription|s = RobotRaconteur.SubscribeService(rr_url()); l = addlistener(s, 'ClientConnected', @(varargin) rr_clear()); d = s.GetDefaultClientWait(20); RobotRaconteur.Poll(20);
inside a handler of an event|c = rr_bench(); l = addlistener(c, 'fired', @(n, s) rr_clear()); c.fire(1); RobotRaconteur.Poll(20);
inside a handler of a call|c = rr_bench(); c.async_add(1, 2, @(varargin) rr_clear()); RobotRaconteur.Poll(20);
inside a callback|c = rr_bench(); c.advise = @(x) rr_clear(); try, c.consult(1); catch, end;
a service|rr_serve(); d = RobotRaconteur.ConnectService(rr_served_url()); d.add(1, 2); w = d.force.Connect();
inside a request to a service|rr_serve(@() rr_clear()); d = RobotRaconteur.ConnectService(rr_served_url()); try, d.stop(); catch, end;
STATES
)
# in_states NAME CODE: after each state, in one process.
in_states() {
  local name code all= count=0
  while IFS='|' read -r name code; do
    all+="$code $2 c = rr_bench(); assert(c.add(1, 2), int32(3)); disp('lived through $name');"$'\n'
    count=$((count + 1))
  done <<< "$states"
  expect "$1 in $count states" 0 'went on' "$all disp('went on')"
  [ "$(grep -c '^lived through' "$work/output")" = $count ] || { cat "$work/output"; exit 1; }
  ! grep -q 'max_recursion_depth' "$work/output" || { cat "$work/output"; exit 1; }
}
in_states 'clear all' 'clear all;'
in_states 'Shutdown' 'RobotRaconteur.Shutdown();'
in_states 'clear all and Shutdown' 'clear all; RobotRaconteur.Shutdown();'
expect 'a handler whose object was cleared' 0 'handled 2' "c = rr_bench();
  l = addlistener(c, 'fired', @(n, s) printf('handled %d\n', c.add(n, 1))); c.fire(1); clear all;
  c = rr_bench(); RobotRaconteur.Poll(20); c.stop();"

expect '1,000 loads and unloads' 0 'went on' "for i = 1:1000
    rrmex('now'); assert(mislocked('rrmex')); RobotRaconteur.Shutdown(); clear -f rrmex; end
  c = rr_bench(); assert(c.add(1, 2), int32(3)); disp('went on')"
expect '100 loads and unloads with connections' 0 'went on' "for i = 1:100
    c = rr_bench(); c.advise = @(x) x; assert(c.consult(i), i); RobotRaconteur.Shutdown(); clear all; end
  disp('went on')"

# Last: it takes the service with it.
expect 'a killed service' 0 'went on' "c = rr_bench(); w = c.level.Connect(); p = c.numbers.Connect();
  g = c.count(2); c.advise = @(x) x; l = addlistener(c, 'fired', @(n, s) n); m = c.grid;
  s = RobotRaconteur.SubscribeService(rr_url()); d = s.GetDefaultClientWait(20); other = rr_bench();
  c.async_nap(15, @(varargin) rr_log_call(varargin{:}));
  function refused(call, name, text), try, call(); error('not thrown'); catch err,
    assert(err.identifier, ['RobotRaconteur:', name]);
    assert(~isempty(regexp(err.message, text)), '%s', err.message); end, end
  refused(@() other.crash(), 'ConnectionError', 'connection');
  assert(rr_eventually(@() ~w.IsOpen && ~p.IsOpen && numel(rr_log_call()) == 1));
  ended = rr_log_call(){1}{3}; assert(ended.identifier, 'RobotRaconteur:ConnectionError');
  for f = {@() c.add(1, 2), @() c.v_double, @() c.get_tool(), @() g.Next(), @() c.consult(1), @() m(1), ...
           @() c.level.Connect(), @() RobotRaconteur.MonitorEnter(c, 1), @() rr_bench(), ...
           @() RobotRaconteur.RequestObjectLock(c, 'User')}
    refused(f{1}, 'ConnectionError', '^(the other side closed the connection|cannot connect to .*refused)$');
  end
  refused(@() p.SendPacket(1), 'InvalidOperation', '^the pipe endpoint is closed$');
  refused(@() p.ReceivePacketWait(20), 'InvalidOperation', '^the pipe endpoint is closed$');
  refused(@() s.GetDefaultClientWait(0.5), 'OperationTimeout', 'no client has come: .*');
  assert(~isempty(strfind(evalc('disp(c)'), 'the connection has ended')));
  clear all; disp('went on')"
echo 'all passed'
