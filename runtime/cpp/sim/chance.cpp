// SPDX-License-Identifier: Apache-2.0
// Random numbers of the C++ library: in a run they follow from its seed.
#include <unistd.h>

#include <cstdlib>
#include <random>

#include "runtime/cpp/sim/scheduler.hpp"

std::random_device::result_type std::random_device::_M_getval() {
  result_type value = 0;
  if (rr::sim::Scheduler* const run = rr::sim::Scheduler::current()) {
    return static_cast<result_type>(run->random().next());
  }
  if (::getentropy(&value, sizeof value) != 0) std::abort();
  return value;
}
