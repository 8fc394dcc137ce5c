#!/usr/bin/env bash
# SPDX-License-Identifier: Apache-2.0
# A program that calls an async_ member without rr/async.hpp is refused by the compiler with the name of what is missing.
# Usage: async_header_test.sh COMPILER SOURCE_TREE
set -euo pipefail
compiler=$1 top=$2
flags=(-std=c++20 -fsyntax-only -x c++ "-I$top/runtime/cpp/include" "-I$top/compiler/backends/cpp/golden")

# program HEADER...
program() {
  printf '#include <%s>\n' "$@" experimental/properties.hpp
  printf 'void ask(experimental::properties::BoardStub& board) {\n  board.async_get_gain([](std::exception_ptr, double) {});\n}\n'
}

program rr/async.hpp | "$compiler" "${flags[@]}" -
if said=$(program rr/node.hpp | "$compiler" "${flags[@]}" - 2>&1); then
  echo "a program without rr/async.hpp is compiled"
  exit 1
fi
grep -q AsyncHeaderIsIncluded <<<"$said" || { echo "$said"; exit 1; }
