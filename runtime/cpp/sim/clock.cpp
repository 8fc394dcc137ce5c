// SPDX-License-Identifier: Apache-2.0
// The clocks and pauses of the C library, in a run.
#include "runtime/cpp/sim/clock.hpp"

#include <sched.h>
#include <sys/time.h>

#include <algorithm>

#include "runtime/cpp/sim/real.hpp"

namespace rr::sim {
namespace {

constexpr Nanoseconds second = 1'000'000'000;
// Where the clocks stand when a run begins: the machine has run a while, and the date is a date.
constexpr Nanoseconds uptime = 5'000 * second;
constexpr Nanoseconds date = 1'800'000'000 * second;
constexpr Nanoseconds longest = INT64_MAX / 4;

Nanoseconds beginning(clockid_t clock) { return clock == CLOCK_REALTIME ? date : uptime; }

}  // namespace

timespec shown_by(clockid_t clock, Nanoseconds now) {
  const Nanoseconds shown = beginning(clock) + now;
  return {shown / second, shown % second};
}

Nanoseconds length_of(const timespec& length) {
  if (length.tv_sec >= longest / second) return never;
  return length.tv_sec * second + length.tv_nsec;
}

Nanoseconds time_of(clockid_t clock, const timespec& shown) {
  const Nanoseconds length = length_of(shown);
  return length == never ? never : std::max<Nanoseconds>(length - beginning(clock), 0);
}

}  // namespace rr::sim

using rr::sim::Nanoseconds;
using rr::sim::Real;
using rr::sim::Scheduler;

extern "C" {

int clock_gettime(clockid_t clock, timespec* shown) noexcept {
  Scheduler* const run = Scheduler::current();
  if (run == nullptr) {
    static constinit Real<int(clockid_t, timespec*)> call{"clock_gettime"};
    return call(clock, shown);
  }
  *shown = rr::sim::shown_by(clock, run->read_clock());
  return 0;
}

time_t time(time_t* result) noexcept {
  timespec shown{};
  clock_gettime(CLOCK_REALTIME, &shown);
  if (result != nullptr) *result = shown.tv_sec;
  return shown.tv_sec;
}

int gettimeofday(timeval* __restrict shown, void* __restrict) noexcept {
  timespec precise{};
  clock_gettime(CLOCK_REALTIME, &precise);
  *shown = {precise.tv_sec, precise.tv_nsec / 1000};
  return 0;
}

int clock_nanosleep(clockid_t clock, int flags, const timespec* time, timespec* left) {
  Scheduler* const run = Scheduler::current();
  if (run == nullptr) {
    static constinit Real<int(clockid_t, int, const timespec*, timespec*)> call{"clock_nanosleep"};
    return call(clock, flags, time, left);
  }
  Nanoseconds until = rr::sim::time_of(clock, *time);
  if ((flags & TIMER_ABSTIME) == 0) {
    const Nanoseconds length = rr::sim::length_of(*time);
    until = length >= rr::sim::never - run->now() ? rr::sim::never : run->now() + length;
  }
  run->wait("a pause", &Scheduler::self(), until, __builtin_return_address(0));
  return 0;
}

int nanosleep(const timespec* time, timespec* left) {
  return clock_nanosleep(CLOCK_MONOTONIC, 0, time, left);
}

int sched_yield() noexcept {
  Scheduler* const run = Scheduler::current();
  if (run == nullptr) {
    static constinit Real<int()> call{"sched_yield"};
    return call();
  }
  run->yield();
  return 0;
}
}
