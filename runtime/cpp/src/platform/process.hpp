// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <chrono>
#include <cstdint>

namespace rr::platform {

/// What this process takes of the machine.
struct ProcessUse {
  std::uint64_t resident = 0;           ///< bytes in memory; 0: unknown
  std::chrono::microseconds processor;  ///< time of all threads
};
ProcessUse process_use();

}  // namespace rr::platform
