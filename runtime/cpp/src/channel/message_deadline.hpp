// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <atomic>
#include <cstddef>

#include "runtime/cpp/src/channel/time.hpp"

namespace rr::channel {

/// How long a message that has begun to come may take. Any thread.
class MessageDeadline {
 public:
  /// A message of so many bytes has begun. `allowance`: the time beyond what a slow line takes.
  void begin(std::size_t size, Milliseconds allowance) {
    const Milliseconds time = saturated(allowance) + Milliseconds(size * 1000 / bytes_a_second);
    span_.store(time, std::memory_order_relaxed);
    due_.store(after(coarse_now(), time), std::memory_order_relaxed);
  }
  void end() { due_.store(never, std::memory_order_relaxed); }
  [[nodiscard]] bool is_set() const { return due() != never; }
  [[nodiscard]] Time due() const { return due_.load(std::memory_order_relaxed); }
  /// The message could not be read meanwhile: it gets the same time once more.
  void restart() {
    Time due = due_;
    if (due != never) due_.compare_exchange_strong(due, after(Clock::now(), span_));
  }

 private:
  // The slowest that a message may come.
  static constexpr std::size_t bytes_a_second = 64 * 1024;

  std::atomic<Time> due_{never};
  std::atomic<Milliseconds> span_{};
};

}  // namespace rr::channel
