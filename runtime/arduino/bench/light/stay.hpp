// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <unistd.h>

namespace rr::serial::testing {

/// Waits until standard input ends, which it does when whoever has started the program goes.
inline void stay() {
  char byte = 0;
  while (::read(STDIN_FILENO, &byte, 1) > 0) continue;
}

}  // namespace rr::serial::testing
