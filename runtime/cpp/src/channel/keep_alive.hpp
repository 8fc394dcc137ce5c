// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <algorithm>
#include <atomic>

#include "runtime/cpp/src/channel/time.hpp"

namespace rr::channel {

/// Decides by the times of what was sent and received when a heartbeat is due on a connection, and
/// when the connection ends: the other side does not say who it is, does not answer any more, or
/// has had the time of close_at(). Sends and closes nothing itself. Any thread may call.
class KeepAlive {
 public:
  struct Terms {
    Milliseconds first_message_timeout{};  ///< for the other side to say who it is
    Milliseconds receive_timeout{};        ///< for an answer to what was sent last
    Milliseconds heartbeat_period{};       ///< in which something is sent
  };
  /// What a look has found.
  struct Look {
    const char* failure = nullptr;  ///< the connection is to be closed for this reason
    bool is_test_due = false;       ///< a heartbeat
    Time next = never;              ///< when to look again
  };

  /// `now`: the connection begins.
  KeepAlive(const Terms& terms, Time now) : terms_(terms), created_(now), last_received_(now) {}

  /// Whether the other side has said who it is, or need not.
  void set_heard(bool was_heard) { was_heard_ = was_heard; }
  [[nodiscard]] bool was_heard() const { return was_heard_.load(std::memory_order_relaxed); }
  /// Something has come, or was taken.
  void note_received(Time now) { last_received_.store(now, std::memory_order_relaxed); }
  [[nodiscard]] Time last_received() const {
    return last_received_.load(std::memory_order_relaxed);
  }
  void close_at(Time when) { close_at_ = when; }

  /// When to look at a connection that begins: after `soon` at the latest.
  [[nodiscard]] Time first_look(Time now, Milliseconds soon) const {
    return after(now, std::min(soon, terms_.heartbeat_period));
  }
  /// `is_full`: this side does not read, so that the other one may be quiet.
  [[nodiscard]] Look look(Time now, Time last_sent, bool is_full) const;

 private:
  const Terms terms_;
  const Time created_;
  std::atomic<Time> last_received_;
  std::atomic<bool> was_heard_{false};
  std::atomic<Time> close_at_{never};
};

}  // namespace rr::channel
