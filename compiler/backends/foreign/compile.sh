#!/bin/sh
# SPDX-License-Identifier: Apache-2.0
# Generates all definitions of this folder, with the renames of its project file, and has compilers read the result:
# C++, C for buses, the sketch for a board, and Octave for MATLAB.
#   compile.sh ROBDEF COMPILER TREE SCRATCH
set -eu
robdef=$1 compiler=$2 tree=$3 scratch=$4
here=$(cd "$(dirname "$0")" && pwd)
rm -rf "$scratch"
mkdir -p "$scratch"
generate() {
  language=$1
  shift
  "$robdef" generate --config "$here/robdef.toml" --allow warnings --lang "$language" -o "$scratch/$language" "$@"
}

generate cpp
find "$scratch/cpp" -name '*.cpp' | sort | xargs -P 2 -n 1 "$compiler" -std=c++20 -fsyntax-only \
  -Wall -Wextra -Wpedantic -Wshadow -Wconversion -Werror -I "$scratch/cpp" -I "$tree/runtime/cpp/include"

generate cbus
find "$scratch/cbus" -name '*_bus.c' | sort | xargs -n 1 cc -std=c99 -fsyntax-only -Wall -Wextra -Werror \
  -I "$scratch/cbus" -I "$tree/runtime/cbus"

generate matlab
octave-cli --norc --path "$tree/runtime/matlab/toolbox" "$tree/compiler/backends/matlab/parse_generated.m" \
  "$scratch/matlab"

generate arduino "$here/experimental.foreign.board.robdef"
core=/usr/share/arduino/hardware/arduino/avr
avr-g++ -mmcu=atmega328p -DF_CPU=16000000L -DARDUINO=10819 -Os -std=gnu++11 -fno-exceptions -fsyntax-only \
  -I "$core/cores/arduino" -I "$core/variants/standard" -I "$tree/runtime/arduino/src" -x c++ -include Arduino.h \
  "$scratch/arduino/experimental_foreign_board/experimental_foreign_board.ino"
