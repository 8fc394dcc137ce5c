// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <chrono>
#include <cstddef>
#include <map>
#include <optional>
#include <string>
#include <vector>

#include "gateway/carrier.hpp"

namespace rr::gateway {

/// Which lives have fallen silent, for a broker that publishes no wills: one that lives repeats a
/// beat, and every reader concludes by itself that it does not any more. No threads, no clock.
class LifeWatch {
 public:
  using Clock = std::chrono::steady_clock;

  /// After `limit` without a beat a life is lost.
  explicit LifeWatch(std::chrono::milliseconds limit) : limit_(limit) {}

  /// A new connection: nothing is known.
  void clear() { lives_.clear(); }
  /// What a beat says.
  struct Beat {
    std::string instance;              ///< of the process that lives
    Message will;                      ///< to be delivered when it falls silent
    std::chrono::milliseconds age{0};  ///< since it was sent
  };
  /// A beat of the life at `topic`. Returns what is to be delivered now: the life itself, when this
  /// instance was lost and is not.
  std::optional<Message> beat(const std::string& topic, Beat beat, Clock::time_point now);
  /// The life at `topic` has ended by itself.
  void end(const std::string& topic) { lives_.erase(topic); }
  /// A message of a life. Returns what is to be delivered: the same, or the will where the life is
  /// lost and the message was retained.
  Message life(Message message, Clock::time_point now);
  /// Wills of lives that are lost since the last call.
  std::vector<Message> take_lost(Clock::time_point now);

 private:
  static constexpr std::size_t most_lives = 100'000;

  struct Life {
    std::string instance;
    Message will;
    std::optional<Message> newest;
    Clock::time_point heard;
    bool is_lost = false;
  };

  const std::chrono::milliseconds limit_;
  std::map<std::string, Life> lives_;  // by topic
};

}  // namespace rr::gateway
