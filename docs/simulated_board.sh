# SPDX-License-Identifier: Apache-2.0
# Sourced by the test of the quick start, in place of an upload to a board: compiles the sketch SKETCH.ino for an Uno, runs it on
# a simulated one, and sets BOARD to its port. Needs ROBDEF_BUILD and ROBDEF_SOURCE; ROBDEF_SIMULATED_BOARD is
# the program that simulates it, where that is not in the build.
#   source simulated_board.sh SKETCH.ino
run_on_simulated_board() {
  local sketch=$1 folder tries
  sketch=$(cd "$(dirname "$1")" && pwd)/$(basename "$1")
  folder=$(mktemp -d "$HOME/board.XXXXXX")
  cmake -S "$ROBDEF_SOURCE/runtime/arduino/avr" -B "$folder" -G Ninja --log-level=WARNING \
    --toolchain "$ROBDEF_SOURCE/runtime/arduino/avr/toolchain.cmake" \
    -D SKETCHES="sketch|$sketch|115200" -D GOLDEN_DIR="$folder" -D PANEL_DIR="$folder" &&
    cmake --build "$folder" || return
  # It ends with its input.
  mkfifo "$folder/stay"
  "${ROBDEF_SIMULATED_BOARD:-$ROBDEF_BUILD/bin/simulated_board}" "$folder/sketch.elf" <"$folder/stay" >"$folder/out" 2>&1 &
  exec 9>"$folder/stay"
  for ((tries = 0; tries < 200; ++tries)); do
    BOARD=$(sed -n 's/^port //p' "$folder/out")
    [ -z "$BOARD" ] || { export BOARD; return; }
    sleep 0.05
  done
  cat "$folder/out" >&2
  return 1
}
run_on_simulated_board "$1"
