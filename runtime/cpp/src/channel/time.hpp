// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <algorithm>
#include <chrono>

#include "rr/mutex.hpp"
#include "runtime/cpp/src/platform/clock.hpp"

/// The runtime's clocks.
namespace rr::channel {

using Clock = std::chrono::steady_clock;
using Time = Clock::time_point;
using Milliseconds = std::chrono::milliseconds;

/// Later than everything.
inline constexpr Time never = Time::max();

using platform::coarse_now;

/// As long as for ever: what a span is cut to, so that it can be added, compared and enlarged
/// without overflow.
inline constexpr Milliseconds longest_span = std::chrono::hours(24 * 365 * 100);
inline constexpr Milliseconds saturated(Milliseconds span) {
  return std::clamp(span, -longest_span, longest_span);
}

/// `now + span`, or never when the span is as long as for ever.
inline Time after(Time now, Milliseconds span) {
  return span >= longest_span ? never : now + saturated(span);
}

/// Waits until notified or `deadline`; spurious returns are possible.
inline void wait_until(Condition& condition, Mutex& mutex, Time deadline) RR_REQUIRES(mutex) {
  if (deadline == never) {
    condition.wait(mutex);
    return;
  }
#if defined(__SANITIZE_THREAD__)
  // The thread sanitizer of g++ 12 does not see the wait on a steady clock give up the mutex.
  condition.wait_until(mutex, std::chrono::system_clock::now() + (deadline - Clock::now()));
#else
  condition.wait_until(mutex, deadline);
#endif
}

/// What one connection has brought is handled by a polling thread for so long before it serves
/// others.
inline constexpr std::chrono::microseconds longest_turn{250};
/// Long work on other threads yields the processor this often; the threads of a node ask for slices
/// of this length.
inline constexpr std::chrono::microseconds longest_slice{100};

}  // namespace rr::channel
