// SPDX-License-Identifier: Apache-2.0
// Random bytes of the system: in a run they follow from its seed.
#include <sys/syscall.h>
#include <unistd.h>

#include <algorithm>
#include <cstddef>

#include "runtime/cpp/sim/scheduler.hpp"

extern "C" int getentropy(void* to, size_t size) {
  rr::sim::Scheduler* const run = rr::sim::Scheduler::current();
  if (run == nullptr) {
    return ::syscall(SYS_getrandom, to, size, 0) == static_cast<long>(size) ? 0 : -1;
  }
  auto* const bytes = static_cast<unsigned char*>(to);
  std::generate_n(bytes, size, [run] { return static_cast<unsigned char>(run->random().next()); });
  return 0;
}
