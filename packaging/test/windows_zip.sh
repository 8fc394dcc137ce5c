#!/usr/bin/env bash
# SPDX-License-Identifier: Apache-2.0
# Unpacks the zip for Windows and uses it in wine: generates code with its robdef.exe, compiles the smart room and a program
# in C with mingw-w64 against its headers and libraries, and runs them.
# Usage: windows_zip.sh PACKAGES SOURCE WINE_PREFIX
set -euo pipefail
packages=$(cd "$1" && pwd) source=$(cd "$2" && pwd)
mkdir -p "$3"
export WINEPREFIX WINEDEBUG=-all
WINEPREFIX=$(realpath "$3")
work=$(mktemp -d)
trap 'rm -rf "$work"' EXIT
fail() { echo "windows_zip: $*" >&2; exit 1; }
python3 -m zipfile -e "$packages"/robdef-[0-9]*-windows-x64.zip "$work"
prefix=$(echo "$work"/robdef-*)
for file in bin/robdef.exe bin/robdef_c.dll lib/librobdef.a lib/librobdef_c.dll.a lib/robdef_c.def include/rr.h include/rr/node.hpp \
  lib/cmake/robdef/robdefConfig.cmake LICENSE README.md licences/antlr4-cpp-runtime.txt; do
  [ -f "$prefix/$file" ] || fail "there is no $file"
done
"$source/runtime/c/test/dll_test.py" "$prefix/bin/robdef_c.dll" "$source/runtime/c/test/symbols.txt"
"$source/runtime/csharp/native_names_test.py" "$prefix/bin/robdef_c.dll"
wine "$prefix/bin/robdef.exe" --version >"$work/version" 2>"$work/err" || { cat "$work/err" >&2; fail 'robdef.exe does not start'; }
[ "$(cat "$work/version")" = "robdef $("$source/tools/version")" ] || fail "robdef.exe says: $(cat "$work/version")"

cat >"$work/windows.cmake" <<'END'
set(CMAKE_SYSTEM_NAME Windows)
set(CMAKE_C_COMPILER x86_64-w64-mingw32-gcc-posix)
set(CMAKE_CXX_COMPILER x86_64-w64-mingw32-g++-posix)
set(CMAKE_EXE_LINKER_FLAGS_INIT -static)
END
room=$source/examples/smart_room
cmake -G Ninja -S "$room/installed" -B "$work/room" -D CMAKE_BUILD_TYPE=Release -D CMAKE_TOOLCHAIN_FILE="$work/windows.cmake" \
  -D CMAKE_PREFIX_PATH="$prefix" -D ROBDEF_EXECUTABLE="$("$source/tools/cross/in_wine" "$prefix/bin/robdef.exe" "$WINEPREFIX")" \
  >"$work/log" 2>&1 && ninja -C "$work/room" >>"$work/log" 2>&1 || { cat "$work/log" >&2; fail 'the smart room is not compiled'; }
programs=()
for program in service client; do
  programs+=("$("$source/tools/cross/in_wine" "$work/room/smart_room_$program.exe" "$WINEPREFIX")")
done
"$room/end_to_end_test.sh" "${programs[@]}"

# In C, with the DLL beside the program.
test=$source/runtime/c/test
x86_64-w64-mingw32-gcc-posix -std=c11 -O1 -static -I"$prefix/include" -o "$prefix/bin/c_program.exe" "$test"/all_members_*.c \
  "$test"/{board_service,counter_service,packing,service_parts}.c "$prefix/lib/librobdef_c.dll.a" -lpthread
wine "$prefix/bin/c_program.exe" >"$work/out" 2>"$work/err" || { cat "$work/err" >&2; fail 'the program in C fails'; }
grep -q PASSED "$work/out" || fail 'the program in C crashes'
echo 'windows_zip: passed'
