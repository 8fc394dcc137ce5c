// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <atomic>
#include <cstdint>

#include "rr/time_spec.hpp"
#include "runtime/cpp/src/channel/time.hpp"

/// The times that a node gives to what it sends (07, section 13).
namespace rr::endpoint {

/// Nanoseconds since 1970 UTC by the clock of one node.
using SenderTime = std::int64_t;

TimeSpec as_time_spec(SenderTime time);

/// The time of day when it was made, plus what a monotonic clock has counted from then: steps of
/// the time of day do not show.
class SenderClock {
 public:
  SenderClock();
  [[nodiscard]] SenderTime now() const;

 private:
  const SenderTime start_;
  const channel::Time started_;
};

/// The times of one sender, each later than those before.
class SenderTimes {
 public:
  SenderTime draw(const SenderClock& clock);

 private:
  std::atomic<SenderTime> last_{0};
};

}  // namespace rr::endpoint
