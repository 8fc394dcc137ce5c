// SPDX-License-Identifier: Apache-2.0
#include "runtime/cpp/sim/faults.hpp"

namespace rr::sim {
namespace {

constexpr std::size_t smallest_refused = 4'096;

__thread bool is_spared = false;

}  // namespace

Faults& Faults::current() {
  static Faults faults;
  return faults;
}

Nanoseconds Faults::next_spurious_wake_up(Scheduler& run) const {
  if (!run.random().once_in(spurious_wake_ups)) return never;
  // Soon, or when most of a wait is over.
  const std::uint64_t longest = run.random().once_in(2) ? 5'000'000 : 2'000'000'000;
  return run.now() + static_cast<Nanoseconds>(run.random().below(longest));
}

bool Faults::refuses_thread(Scheduler& run) const {
  return !is_spared && run.random().once_in(refused_threads);
}

bool Faults::refuses_memory(Scheduler& run, std::size_t size) const {
  if (refused_memory == 0 || is_spared || Spared::is_in_effect()) return false;
  // Small blocks are there: systems end the process before they refuse them.
  if (size < smallest_refused) return false;
  const Spared spared;
  return run.random().once_in(refused_memory);
}

void Faults::spare_this_thread() { is_spared = true; }

}  // namespace rr::sim
