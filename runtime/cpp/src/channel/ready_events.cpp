// SPDX-License-Identifier: Apache-2.0
#include "runtime/cpp/src/channel/ready_events.hpp"

namespace rr::channel {

// Looks at all, since each that is not the first for `own` is merged into that.
bool ReadyEvents::has_others(std::size_t first, const void* own, Event*& kept) {
  bool is_found = false;
  for (std::size_t i = first; i < count_; ++i) {
    Event& event = events_[i];
    if (event.key == nullptr) continue;
    if (event.key != own) {
      is_found = true;
    } else if (kept == nullptr) {
      kept = &event;
    } else {
      kept->events |= event.events;
      event.key = nullptr;
    }
  }
  return is_found;
}

// What was the last one, and has been merged, leaves its place to others.
void ReadyEvents::drop_merged() {
  while (count_ > next_ && events_[count_ - 1].key == nullptr) --count_;
}

}  // namespace rr::channel
