// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <cstddef>
#include <memory>
#include <span>

#include "runtime/cpp/src/platform/poller.hpp"

namespace rr::channel {

/// The events that one call of the poller has brought, and that are handled one after the other.
/// An event without a key is a wake-up. Belongs to the thread that has the turn to poll.
class ReadyEvents {
 public:
  using Event = platform::Poller::Event;
  static constexpr std::size_t capacity = platform::Poller::most_events;

  ReadyEvents() : events_(std::make_unique<Event[]>(capacity)) {}

  /// All were handled.
  [[nodiscard]] bool empty() const { return next_ == count_; }
  /// Events that have come together, handled ones too.
  [[nodiscard]] std::size_t size() const { return count_; }
  /// The next one is handled now. Only when there is one.
  const Event& take() { return events_[next_++]; }

  /// Fetches others in place of those that were handled: `wait(room)` fills in a span of events and
  /// returns how many. Only when all were handled.
  template <class Wait>
  void fetch(const Wait& wait) {
    count_ = wait(std::span<Event>(events_.get(), capacity));
    next_ = 0;
  }
  /// Fetches more behind those that are still to be handled, unless these are enough to answer:
  /// whether there is one for another key than `own`. Several for `own` become one.
  template <class Wait>
  [[nodiscard]] bool find_others(const void* own, const Wait& wait) {
    Event* kept = nullptr;
    if (has_others(next_, own, kept)) return true;
    const std::span<Event> room(events_.get() + count_, capacity - count_);
    const std::size_t before = count_;
    if (!room.empty()) count_ += wait(room);
    const bool is_found = has_others(before, own, kept);
    drop_merged();
    return is_found;
  }

 private:
  bool has_others(std::size_t first, const void* own, Event*& kept);
  void drop_merged();

  const std::unique_ptr<Event[]> events_;
  std::size_t next_ = 0;
  std::size_t count_ = 0;
};

}  // namespace rr::channel
