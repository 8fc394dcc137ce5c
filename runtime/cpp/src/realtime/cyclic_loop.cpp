// SPDX-License-Identifier: Apache-2.0
#include "rr/realtime/cyclic_loop.hpp"

#include <pthread.h>
#include <sys/mman.h>
#include <time.h>

#include <algorithm>
#include <cerrno>
#include <cmath>

#include "rr/error.hpp"
#include "rr/realtime/lockstep.hpp"

namespace rr::realtime {
namespace {

constexpr std::int64_t second = 1'000'000'000;

}  // namespace

Nanoseconds SteadyClock::now() {
  timespec time{};
  clock_gettime(CLOCK_MONOTONIC, &time);
  return Nanoseconds(std::int64_t{time.tv_sec} * second + time.tv_nsec);
}

void SteadyClock::sleep_until(Nanoseconds time) {
  const timespec until{.tv_sec = time.count() / second, .tv_nsec = time.count() % second};
  while (clock_nanosleep(CLOCK_MONOTONIC, TIMER_ABSTIME, &until, nullptr) == EINTR) {
  }
}

void JitterHistogram::add(Nanoseconds time) {
  const std::int64_t nanoseconds = std::max<std::int64_t>(time.count(), 0);
  const auto bin =
      std::min<std::uint64_t>(static_cast<std::uint64_t>(nanoseconds / 1000), bin_count);
  // One thread adds, so none of these needs more than a load and a store.
  const auto raise = [](auto& number, auto by) {
    number.store(number.load(std::memory_order_relaxed) + by, std::memory_order_relaxed);
  };
  raise(bins_[bin], std::uint64_t{1});
  raise(count_, std::uint64_t{1});
  raise(sum_, nanoseconds);
  if (nanoseconds > largest_.load(std::memory_order_relaxed)) {
    largest_.store(nanoseconds, std::memory_order_relaxed);
  }
}

Nanoseconds JitterHistogram::mean() const {
  const std::uint64_t all = count();
  if (all == 0) return Nanoseconds(0);
  return Nanoseconds(sum_.load(std::memory_order_relaxed) / static_cast<std::int64_t>(all));
}

Nanoseconds JitterHistogram::quantile(double part) const {
  const auto wanted = static_cast<std::uint64_t>(std::ceil(part * static_cast<double>(count())));
  std::uint64_t seen = 0;
  for (std::size_t i = 0; i < bin_count; ++i) {
    seen += bins_[i].load(std::memory_order_relaxed);
    if (seen >= wanted) {
      return std::min(Nanoseconds(static_cast<std::int64_t>(i + 1) * 1000), largest());
    }
  }
  return largest();
}

std::vector<std::uint64_t> JitterHistogram::bins() const {
  std::vector<std::uint64_t> result;
  for (const auto& bin : bins_) result.push_back(bin.load(std::memory_order_relaxed));
  return result;
}

CyclicLoop::CyclicLoop(Nanoseconds period, Clock& clock) : period_(period), clock_(clock) {
  if (period <= Nanoseconds(0)) {
    throw Error(ErrorCode::invalid_argument, "the period of a loop is not positive");
  }
  next_.due = clock.now() + period;
}

void CyclicLoop::finish(Nanoseconds begin, Nanoseconds end) {
  const auto raise = [](std::atomic<std::uint64_t>& number, std::uint64_t by) {
    number.store(number.load(std::memory_order_relaxed) + by, std::memory_order_relaxed);
  };
  counts_.lateness.add(begin - next_.due);
  counts_.duration.add(end - begin);
  raise(counts_.cycles, 1);
  ++next_.number;
  next_.due += period_;
  if (end <= next_.due) return;
  raise(counts_.overruns, 1);
  // The next one, if late, is still run: its own time has not ended.
  const auto missed = static_cast<std::uint64_t>((end - next_.due) / period_);
  raise(counts_.skipped, missed);
  next_.number += missed;
  next_.due += period_ * static_cast<std::int64_t>(missed);
}

ThreadRights become_realtime(int priority) {
  ThreadRights rights;
  sched_param parameters{};
  parameters.sched_priority = priority;
  rights.has_priority = pthread_setschedparam(pthread_self(), SCHED_FIFO, &parameters) == 0;
  rights.has_locked_memory = mlockall(MCL_CURRENT | MCL_FUTURE) == 0;
  return rights;
}

CyclicLoop& Lockstep::add(Nanoseconds period, Function function) {
  parts_.push_back({std::make_unique<CyclicLoop>(period, clock_), std::move(function)});
  return *parts_.back().loop;
}  // NOLINT(clang-analyzer-cplusplus.NewDeleteLeaks): the list has it

void Lockstep::run_until(Nanoseconds time) {
  const auto due = [](const Part& part) { return part.loop->next_due(); };
  while (!parts_.empty()) {
    const auto first = std::ranges::min_element(parts_, {}, due);
    if (due(*first) > time) break;
    clock_.sleep_until(due(*first));
    first->loop->run_cycle(first->function);
  }
  clock_.sleep_until(time);
}

}  // namespace rr::realtime
