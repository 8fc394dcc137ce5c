// SPDX-License-Identifier: Apache-2.0
#include "runtime/cpp/src/channel/keep_alive.hpp"

#include <algorithm>

namespace rr::channel {

static_assert(std::atomic<Time>::is_always_lock_free);

KeepAlive::Look KeepAlive::look(Time now, Time last_sent, bool is_full) const {
  const Time close_at = close_at_;
  if (now >= close_at) return {.failure = "the connection was closed"};
  const bool must_say_who = !was_heard();
  const Time first_message_due = after(created_, terms_.first_message_timeout);
  if (must_say_who && now >= first_message_due) {
    return {.failure = "the other side has not said who it is"};
  }
  if (!is_full && last_sent - last_received() > terms_.receive_timeout) {
    return {.failure = "the other side does not answer any more"};
  }
  Look result{.next = after(last_sent, terms_.heartbeat_period)};
  if (result.next <= now) {
    result.is_test_due = !must_say_who;
    result.next = after(now, terms_.heartbeat_period);
  }
  if (must_say_who) result.next = std::min(result.next, first_message_due);
  // Many connections of one age are looked after together.
  constexpr Milliseconds grain{50};
  if (result.next != never && terms_.heartbeat_period > 100 * grain) {
    result.next += grain - (result.next - Time{}) % grain;
  }
  result.next = std::min(result.next, close_at);
  return result;
}

}  // namespace rr::channel
