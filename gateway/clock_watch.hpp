// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <chrono>
#include <cstdint>

namespace rr::gateway {

/// Notices when the system's clock is set while the process runs.
class ClockWatch {
 public:
  using Clock = std::chrono::steady_clock;

  /// `wall` in nanoseconds since 1970.
  ClockWatch(Clock::time_point now, std::int64_t wall) : offset_(offset(now, wall)) {}

  /// By how much the clock was set since the last call, in nanoseconds; 0 for less than a second,
  /// as when it is steered.
  std::int64_t take_jump(Clock::time_point now, std::int64_t wall) {
    constexpr std::int64_t smallest = 1'000'000'000;
    const std::int64_t jump = offset(now, wall) - offset_;
    offset_ += jump;
    return jump > -smallest && jump < smallest ? 0 : jump;
  }

 private:
  static std::int64_t offset(Clock::time_point now, std::int64_t wall) {
    return wall -
           std::chrono::duration_cast<std::chrono::nanoseconds>(now.time_since_epoch()).count();
  }
  std::int64_t offset_;
};

}  // namespace rr::gateway
