// SPDX-License-Identifier: Apache-2.0
#include "runtime/cpp/src/platform/process.hpp"

#include <sys/resource.h>
#include <unistd.h>

#include <fstream>

namespace rr::platform {

ProcessUse process_use() {
  rusage used{};
  ::getrusage(RUSAGE_SELF, &used);
  const auto time = [](const timeval& value) {
    return std::chrono::seconds(value.tv_sec) + std::chrono::microseconds(value.tv_usec);
  };
  std::uint64_t all = 0;
  std::uint64_t resident = 0;  // pages
  std::ifstream("/proc/self/statm") >> all >> resident;
  return {.resident = resident * static_cast<std::uint64_t>(::sysconf(_SC_PAGESIZE)),
          .processor = time(used.ru_utime) + time(used.ru_stime)};
}

}  // namespace rr::platform
