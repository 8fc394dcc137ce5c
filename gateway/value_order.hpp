// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <algorithm>
#include <chrono>
#include <cstddef>
#include <cstdint>
#include <deque>
#include <optional>

namespace rr::gateway {

/// Which values of a wire are newer than all that were taken. A gateway numbers them, and begins
/// anew with another epoch each time it is started. What a gateway that has ended left on its way
/// may arrive after the first value of the next one: for a minute its epoch is over. No threads, no
/// clock.
class ValueOrder {
 public:
  using Clock = std::chrono::steady_clock;

  /// Whether the value is newer, and is taken by this.
  bool take(std::uint64_t epoch, std::uint64_t number, Clock::time_point now) {
    if (newest_ && newest_->epoch == epoch) {
      if (number <= newest_->number) return false;
    } else {
      std::erase_if(over_, [&](const Over& each) { return now - each.since >= memory; });
      const auto is_this = [&](const Over& each) { return each.epoch == epoch; };
      if (std::any_of(over_.begin(), over_.end(), is_this)) return false;
      if (newest_) over_.push_back({newest_->epoch, now});
      if (over_.size() > most_over) over_.pop_front();
    }
    newest_ = Value{epoch, number};
    return true;
  }

 private:
  static constexpr std::chrono::seconds memory{60};
  static constexpr std::size_t most_over = 8;

  struct Value {
    std::uint64_t epoch;
    std::uint64_t number;
  };
  struct Over {
    std::uint64_t epoch;
    Clock::time_point since;
  };

  std::optional<Value> newest_;
  std::deque<Over> over_;  // oldest first
};

}  // namespace rr::gateway
