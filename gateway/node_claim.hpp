// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <chrono>
#include <cstdint>
#include <optional>
#include <string>
#include <string_view>

#include "gateway/carrier.hpp"

namespace rr::gateway {

/// One gateway for each node of a site: the one that is at the broker keeps the node, and another
/// one is refused. No threads, no clock.
///
/// `<node>/$life` is retained and says which gateway has the node. After each connection a gateway
/// publishes `<node>/$claim`. When its own claim has come back it knows what is retained: nothing
/// of another gateway, and it takes the node; otherwise it waits whether that one objects, by
/// publishing its life again. One that has gone without a word does not. When two have taken the
/// node at once, the one that was started later loses.
class NodeClaim {
 public:
  using Clock = std::chrono::steady_clock;
  enum class State {
    away,     ///< not connected
    asking,   ///< nothing may be published or executed yet
    holding,  ///< the node is this gateway's
    refused,  ///< another gateway has it; for good
  };

  /// `topic` is that of the node. `started` is this gateway's start, in nanoseconds since 1970,
  /// `host` where it runs, for people.
  NodeClaim(std::string topic, std::int64_t started, std::string host);

  /// What to subscribe to: `$life`.
  [[nodiscard]] std::string life_topic() const { return topic_ + "/$life"; }
  /// What to subscribe to: `$claim`.
  [[nodiscard]] std::string claim_topic() const { return topic_ + "/$claim"; }
  /// The life of the node: `up`, `ended`, `lost`.
  [[nodiscard]] Message life(std::string_view state) const;

  /// The connection was made.
  void connected();
  /// It was lost.
  void disconnected();
  /// A message of one of the topics.
  void take(const Message& message, Clock::time_point now);
  /// What is to be published now, before anything else; nothing for nothing. To be called after
  /// take() and connected(), and some times in a second.
  std::optional<Message> next(Clock::time_point now);
  /// While the node is this gateway's: next() gives its life once more.
  void repeat_life() { must_say_life_ = state_ == State::holding; }
  /// Whether a claim or a life is this gateway's.
  [[nodiscard]] bool is_mine(const Message& message) const {
    return message.find("instance") == instance_;
  }
  [[nodiscard]] State state() const { return state_; }
  /// The gateway that has the node, for people: `hall-pc, since 2026-11-27T11:44:16Z`.
  [[nodiscard]] const std::string& holder() const { return holder_; }

 private:
  void take_life(const Message& message);
  void refuse(const Message& life);
  [[nodiscard]] bool is_before_me(const Message& message) const;

  const std::string topic_;
  const std::int64_t started_;
  const std::string host_;
  const std::string instance_;
  State state_ = State::away;
  std::string holder_;
  std::optional<Message> other_;  // the life of another gateway that is up
  bool knows_retained_ = false;
  bool must_say_life_ = false;
  Clock::time_point asked_{};
  Clock::time_point asked_first_{};
  Clock::time_point said_{};
};

}  // namespace rr::gateway
