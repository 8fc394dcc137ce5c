// SPDX-License-Identifier: Apache-2.0
#include "runtime/cpp/sim/faults.hpp"

namespace rr::sim {

Faults& Faults::current() {
  static Faults faults;
  return faults;
}

Nanoseconds Faults::next_spurious_wake_up(Scheduler& run) const {
  if (!run.random().once_in(spurious_wake_ups)) return never;
  return run.now() + static_cast<Nanoseconds>(run.random().below(5'000'000));
}

bool Faults::refuses_thread(Scheduler& run) const { return run.random().once_in(refused_threads); }

bool Faults::refuses_memory(Scheduler& run, std::size_t size) const {
  return size > small_block && run.random().once_in(refused_memory);
}

}  // namespace rr::sim
