#!/usr/bin/env bash
# SPDX-License-Identifier: Apache-2.0
# Unpacks the tarball somewhere and uses it there: the program, CMake, pkg-config. Usage: tarball.sh PACKAGES COMPILER
set -euo pipefail
packages=$(cd "$1" && pwd) compiler=$2
here=$(cd "$(dirname "$0")" && pwd)
work=$(mktemp -d)
trap 'rm -rf "$work"' EXIT
fail() { echo "tarball: $*" >&2; exit 1; }
tar -xzf "$packages"/robdef-[0-9]*-linux-x64.tar.gz -C "$work"
prefix=$(echo "$work"/robdef-*)
needed=$(readelf -d "$prefix/bin/robdef" | sed -n 's/.*NEEDED.*\[\(.*\)\]/\1/p' | grep -vE '^(libc|libm|ld-linux.*)\.so' || true)
[ -z "$needed" ] || fail "robdef needs more than the C library: $needed"
newest=$(objdump -T "$prefix/bin/robdef" | grep -oE 'GLIBC_[0-9.]+' | sort -uV | tail -n 1)
echo "tarball: robdef needs $newest"
"$prefix/bin/robdef" --version

# A new project by CMake, which finds the package by its folder, and everything by pkg-config.
cp "$here"/{one_get.cpp,one_service.cpp,experimental.one.robdef} "$work"
cat >"$work/CMakeLists.txt" <<'END'
cmake_minimum_required(VERSION 3.25)
project(one LANGUAGES CXX)
find_package(robdef REQUIRED COMPONENTS core tls)
add_library(definition STATIC)
robdef_generate(definition FILES experimental.one.robdef LANGUAGE cpp RUNTIME robdef::core)
add_executable(get one_get.cpp)
target_link_libraries(get PRIVATE definition)
add_executable(service one_service.cpp)
target_link_libraries(service PRIVATE definition robdef::tls)
END
cmake -G Ninja -S "$work" -B "$work/build" -D CMAKE_BUILD_TYPE=Debug -D CMAKE_CXX_COMPILER="$compiler" \
  -D CMAKE_PREFIX_PATH="$prefix" >"$work/log" 2>&1 && ninja -C "$work/build" >>"$work/log" 2>&1 || { cat "$work/log" >&2; fail 'CMake'; }
"$work/build/service" >"$work/url" &
while [ ! -s "$work/url" ]; do sleep 0.05; done
[ "$("$work/build/get" "$(cat "$work/url")")" = 42 ] || fail 'it does not work'
wait
! readelf -d "$work/build/get" | grep -q ssl || fail 'the client needs OpenSSL'
readelf -d "$work/build/service" | grep -q ssl || fail 'the service was not linked with TLS'
export PKG_CONFIG_PATH=$(echo "$prefix"/lib/*/pkgconfig)
"$prefix/bin/robdef" generate --lang cpp -o "$work/generated" "$work/experimental.one.robdef"
# shellcheck disable=SC2046  # words
"$compiler" "$work/one_get.cpp" "$work/generated/experimental/one.cpp" -I"$work/generated" -o "$work/by_hand" \
  $(pkg-config --static --cflags --libs robdef-core)
"$work/build/service" >"$work/url2" &
while [ ! -s "$work/url2" ]; do sleep 0.05; done
[ "$("$work/by_hand" "$(cat "$work/url2")")" = 42 ] || fail 'what was built with pkg-config does not work'
wait
echo 'tarball: passed'
