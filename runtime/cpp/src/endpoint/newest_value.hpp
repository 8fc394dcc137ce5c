// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <memory>
#include <utility>

#include "rr/time_spec.hpp"
#include "runtime/cpp/src/channel/time.hpp"

namespace rr::endpoint {

inline bool is_later(const TimeSpec& time, const TimeSpec& other) {
  return time.seconds != other.seconds ? time.seconds > other.seconds
                                       : time.nanoseconds > other.nanoseconds;
}

/// The time that a sender has given to a value, and when that value has arrived.
struct Arrival : TimeSpec {
  Arrival(const TimeSpec& time, channel::Time arrived) : TimeSpec(time), at(arrived) {}

  channel::Time at;
};

/// What has come last, and until when it counts. Not synchronized.
class NewestValue {
 public:
  /// Gives back what was there, which may be large to free.
  std::shared_ptr<const void> put(std::shared_ptr<const void> value, const TimeSpec& time) {
    return put(std::move(value), Arrival(time, channel::Clock::now()));
  }
  /// The same for one that has arrived before.
  std::shared_ptr<const void> put(std::shared_ptr<const void> value, const Arrival& arrival) {
    time_ = arrival;
    arrived_ = arrival.at;
    return std::exchange(value_, std::move(value));
  }
  /// Null for none, and for one that has expired.
  [[nodiscard]] std::shared_ptr<const void> get(TimeSpec& time) const {
    if (!is_fresh()) return nullptr;
    time = time_;
    return value_;
  }
  [[nodiscard]] bool is_fresh() const {
    return value_ && (lifespan_.count() <= 0 || channel::Clock::now() - arrived_ <= lifespan_);
  }
  /// Leaves none.
  [[nodiscard]] std::shared_ptr<const void> take() { return std::exchange(value_, nullptr); }
  /// Whatever its age.
  [[nodiscard]] const std::shared_ptr<const void>& value() const { return value_; }
  /// Its sender's time; of any value before, too.
  [[nodiscard]] const TimeSpec& time() const { return time_; }
  /// 0: values do not expire.
  void set_lifespan(channel::Milliseconds lifespan) { lifespan_ = lifespan; }

 private:
  std::shared_ptr<const void> value_;
  TimeSpec time_;
  channel::Time arrived_{};
  channel::Milliseconds lifespan_{0};
};

}  // namespace rr::endpoint
