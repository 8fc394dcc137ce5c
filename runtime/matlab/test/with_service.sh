# SPDX-License-Identifier: Apache-2.0
# For tests that source it: start_service PROGRAM starts the test service on a free port, until the
# test ends, and sets what the tests in Octave read. `$work` is a folder that goes with the test.
work=$(mktemp -d)
service=
trap '[ -z "$service" ] || kill "$service" 2>/dev/null || true; rm -rf "$work"' EXIT

start_service() {
  : > "$work/service"
  "$1" --port 0 --seconds 1500 > "$work/service" &
  service=$!
  for _ in $(seq 100); do
    grep -q '^ready: ' "$work/service" && break
    sleep 0.1
  done
  RR_TEST_PORT=$(sed -n 's/^ready: //p' "$work/service")
  export RR_TEST_PORT RR_TEST_SERVICE=$1 RR_TEST_FOLDER=$work
}
