// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <cstddef>
#include <string>

namespace rr::testing {

/// What this process holds now.
struct ProcessState {
  std::size_t threads = 0;
  std::size_t descriptors = 0;
  std::size_t allocated = 0;  ///< bytes that the program has not freed
  std::size_t resident = 0;   ///< bytes of memory that are in use, what was freed included

  static ProcessState now();
  [[nodiscard]] std::string text() const;
};

/// Whether this build keeps memory that was freed, to find what uses it still (address sanitizer),
/// or notes of it (thread sanitizer): what is resident then grows up to some hundred megabytes.
bool keeps_freed_memory();

/// How much slower than usual this build is.
int slowness();

}  // namespace rr::testing
