#!/usr/bin/env bash
# SPDX-License-Identifier: Apache-2.0
# The libraries of others that builds for Windows need and Debian does not have: fetched and compiled once. Sourced after
# tools/setup.sh, by tools/cross/windows and tools/cross/windows_package.

# build_openssl: its headers and static libraries, in build/openssl-windows.
build_openssl() {
  local folder=$top/build/openssl-windows work=$top/build/openssl-build compiler=x86_64-w64-mingw32-gcc-posix
  [ ! -d "$folder" ] || return 0
  unpack_source openssl openssl-source
  rm -rf "$work" "$folder.new"
  cp -r "$top/build/openssl-source" "$work"
  ! command -v ccache >/dev/null || compiler="ccache $compiler"
  (
    cd "$work"
    # The library says when it was built: that is when its sources were packed.
    SOURCE_DATE_EPOCH=$(dpkg-parsechangelog --show-field Timestamp)
    export SOURCE_DATE_EPOCH
    ./Configure mingw64 no-shared no-tests no-legacy no-engine no-dso --cross-compile-prefix=x86_64-w64-mingw32- \
      --prefix=/ --openssldir=/openssl --libdir=lib
    make -j "$jobs_count" CC="$compiler" build_libs
    make CC="$compiler" DESTDIR="$folder.new" install_dev
  )
  rm -r "$work"
  mv "$folder.new" "$folder"
}

build_windows_libraries() {
  with_progress source-antlr unpack_source antlr4-cpp-runtime antlr-source
  with_progress openssl-windows build_openssl
}
