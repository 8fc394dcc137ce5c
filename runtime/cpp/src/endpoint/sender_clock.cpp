// SPDX-License-Identifier: Apache-2.0
#include "runtime/cpp/src/endpoint/sender_clock.hpp"

#include <algorithm>
#include <chrono>

namespace rr::endpoint {
namespace {

constexpr SenderTime second = 1'000'000'000;

SenderTime in_nanoseconds(auto span) {
  return std::chrono::duration_cast<std::chrono::nanoseconds>(span).count();
}

}  // namespace

TimeSpec as_time_spec(SenderTime time) {
  return {.seconds = time / second, .nanoseconds = static_cast<std::int32_t>(time % second)};
}

SenderClock::SenderClock()
    : start_(in_nanoseconds(std::chrono::system_clock::now().time_since_epoch())),
      started_(channel::Clock::now()) {}

SenderTime SenderClock::now() const {
  return start_ + in_nanoseconds(channel::Clock::now() - started_);
}

SenderTime SenderTimes::draw(const SenderClock& clock) {
  const SenderTime now = clock.now();
  SenderTime last = last_.load(std::memory_order_relaxed);
  SenderTime next = 0;
  do {
    next = std::max(now, last + 1);
  } while (!last_.compare_exchange_weak(last, next, std::memory_order_relaxed));
  return next;
}

}  // namespace rr::endpoint
