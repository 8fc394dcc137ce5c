// SPDX-License-Identifier: Apache-2.0
#include "runtime/cpp/src/platform/process.hpp"

// The second needs the first, and with this version no library of its own.
#define PSAPI_VERSION 2
// clang-format off
#include <windows.h>
#include <psapi.h>
// clang-format on

namespace rr::platform {

ProcessUse process_use() {
  ProcessUse use{};
  PROCESS_MEMORY_COUNTERS memory{};
  if (GetProcessMemoryInfo(GetCurrentProcess(), &memory, sizeof memory) != 0) {
    use.resident = memory.WorkingSetSize;
  }
  FILETIME made{};
  FILETIME ended{};
  FILETIME kernel{};
  FILETIME user{};
  if (GetProcessTimes(GetCurrentProcess(), &made, &ended, &kernel, &user) != 0) {
    const auto time = [](const FILETIME& value) {  // of 100 ns
      const std::uint64_t units = std::uint64_t{value.dwHighDateTime} << 32U | value.dwLowDateTime;
      return std::chrono::microseconds(units / 10);
    };
    use.processor = time(kernel) + time(user);
  }
  return use;
}

}  // namespace rr::platform
