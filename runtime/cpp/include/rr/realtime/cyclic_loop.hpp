// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <array>
#include <atomic>
#include <chrono>
#include <cstddef>
#include <cstdint>
#include <vector>

#include "rr/visibility.hpp"

namespace RR_VISIBLE rr {

/// Loops of a fixed rate, on the machine's clock or on one that a test moves.
namespace realtime {

/// Times and spans of time.
using Nanoseconds = std::chrono::nanoseconds;

/// Where a loop has its time from, counted from some point that stays.
class Clock {
 public:
  virtual ~Clock() = default;
  /// The time now.
  [[nodiscard]] virtual Nanoseconds now() = 0;
  /// Returns at `time` or soon after; at once when that has passed.
  virtual void sleep_until(Nanoseconds time) = 0;
};

/// CLOCK_MONOTONIC, slept on with absolute times.
class SteadyClock final : public Clock {
 public:
  /// The time now, by CLOCK_MONOTONIC.
  [[nodiscard]] Nanoseconds now() override;
  void sleep_until(Nanoseconds time) override;
};

/// A clock that stands still until it is moved. Sleeping on it moves it too, so a single loop
/// runs as fast as it can; several are kept in step by Lockstep. For one thread.
class SimulatedClock final : public Clock {
 public:
  /// The time to which it was moved last; 0 at first.
  [[nodiscard]] Nanoseconds now() override { return now_; }
  void sleep_until(Nanoseconds time) override {
    if (time > now_) now_ = time;
  }
  /// Moves it to `time`, also back.
  void set(Nanoseconds time) { now_ = time; }

 private:
  Nanoseconds now_{0};
};

/// Counts of times by the microsecond, up to one millisecond; what is longer is counted together.
/// One thread adds; any may read meanwhile, and finds each count right, not all from one moment.
class JitterHistogram {
 public:
  /// Bins of one microsecond each; one more counts what is longer.
  static constexpr std::size_t bin_count = 1000;

  /// Counts one time. Negative ones count as 0.
  void add(Nanoseconds time);
  /// How many times were added.
  [[nodiscard]] std::uint64_t count() const { return count_.load(std::memory_order_relaxed); }
  /// The longest of them; 0 for none.
  [[nodiscard]] Nanoseconds largest() const {
    return Nanoseconds(largest_.load(std::memory_order_relaxed));
  }
  /// Their mean; 0 for none.
  [[nodiscard]] Nanoseconds mean() const;
  /// Below this are so many of all (0.999: all but one of a thousand), to the next microsecond;
  /// when that lies beyond the last bin, the largest.
  [[nodiscard]] Nanoseconds quantile(double part) const;
  /// One count for each microsecond, and at the end that of what is longer.
  [[nodiscard]] std::vector<std::uint64_t> bins() const;

 private:
  std::array<std::atomic<std::uint64_t>, bin_count + 1> bins_{};
  std::atomic<std::uint64_t> count_{0};
  std::atomic<std::int64_t> sum_{0};
  std::atomic<std::int64_t> largest_{0};
};

/// What a loop has seen of itself. Any thread may read it while the loop runs.
struct LoopCounts {
  std::atomic<std::uint64_t> cycles{0};    ///< that have been run
  std::atomic<std::uint64_t> overruns{0};  ///< cycles that ended after the next one was due
  std::atomic<std::uint64_t> skipped{0};   ///< cycles that were left out to be in step again
  JitterHistogram lateness;                ///< from when a cycle was due until it began
  JitterHistogram duration;                ///< from its begin to its end
};

/// One cycle, as the loop's function gets it.
struct Cycle {
  std::uint64_t number = 0;  ///< counts what is skipped too, so number x period is the loop's time
  Nanoseconds due{0};        ///< of the clock
};

/// Calls a function at a fixed rate. After a cycle that took too long the next begins at once;
/// those whose whole period has passed by then are skipped, so that the rate's phase stays.
/// Allocates nothing once it is made; of the kernel it needs the clock only.
class CyclicLoop {
 public:
  /// The first cycle is due one period from now, or from when run() begins. Throws rr::Error
  /// (invalid_argument) for a period that is not positive. The clock outlives the loop.
  CyclicLoop(Nanoseconds period, Clock& clock);

  /// Calls `function(const Cycle&)` until stop(), in the caller's thread, and passes on what it
  /// throws.
  template <class Function>
  void run(Function function) {
    next_.due = clock_.now() + period_;
    while (!is_stopped_.load(std::memory_order_relaxed)) {
      clock_.sleep_until(next_.due);
      run_cycle(function);
    }
  }
  /// One cycle, now: for those who have slept until next_due() themselves.
  template <class Function>
  void run_cycle(Function& function) {
    const Nanoseconds begin = clock_.now();
    function(static_cast<const Cycle&>(next_));
    finish(begin, clock_.now());
  }
  /// Ends run() after the cycle that it is in. By any thread, or by the function.
  void stop() { is_stopped_.store(true, std::memory_order_relaxed); }
  /// When the next cycle is due, by the clock.
  [[nodiscard]] Nanoseconds next_due() const { return next_.due; }
  /// From one cycle to the next.
  [[nodiscard]] Nanoseconds period() const { return period_; }
  /// What the loop has seen of itself; any thread may read it.
  [[nodiscard]] const LoopCounts& counts() const { return counts_; }

 private:
  void finish(Nanoseconds begin, Nanoseconds end);

  Nanoseconds period_;
  Clock& clock_;
  Cycle next_;
  std::atomic<bool> is_stopped_{false};
  LoopCounts counts_;
};

/// What a thread with a loop asks of the system. Each may be refused, since it takes rights.
struct ThreadRights {
  bool has_priority = false;       ///< SCHED_FIFO
  bool has_locked_memory = false;  ///< nothing is swapped out, or paged in later
};
/// Gives the calling thread a real-time priority (1 to 99) and locks the process's memory, as far
/// as the system allows.
ThreadRights become_realtime(int priority);

}  // namespace realtime
}  // namespace rr
