#!/usr/bin/env bash
# SPDX-License-Identifier: Apache-2.0
# Compiles generated buses for a board whose double has four bytes: sizes and offsets are checked by the
# compiler, and the program is linked. Usage: avr_test.sh AVR_GCC FOLDER_OF_RR_BUS FOLDER_OF_BUSES
set -euo pipefail
work=$(mktemp -d)
trap 'rm -rf "$work"' EXIT
cat > "$work/main.c" <<'END'
#include "experimental_arm_bus.h"
static experimental_arm_Command bus;
static uint8_t frame[experimental_arm_Command_FRAME_BYTES];
static rr_bus_frame header;
static rr_bus_order order;
int main(void) {
  experimental_arm_Command_frame(&bus, &header, frame);
  return experimental_arm_Command_receive(&bus, &header, &order, frame, sizeof frame);
}
END
"$1" -mmcu=atmega328p -std=c99 -Os -Wall -Wextra -Werror -I "$2" -I "$3" -ffunction-sections \
  -Wl,--gc-sections -o "$work/bus.elf" "$work/main.c" "$2/rr_bus.c" \
  "$3/experimental_arm_bus.c" "$3/experimental_motion_bus.c"
"$(dirname "$1")/avr-size" "$work/bus.elf"
