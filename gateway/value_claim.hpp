// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <chrono>

#include "gateway/carrier.hpp"
#include "gateway/node_claim.hpp"

namespace rr::gateway {

/// Whether a gateway may publish values of wires. NodeClaim decides over the connection for
/// messages. When that one is lost, values go on over theirs, until another gateway has the node:
/// its life arrives over this connection, too. A new connection for values waits until the node is
/// this gateway's. No threads, no clock.
class ValueClaim {
 public:
  using Clock = std::chrono::steady_clock;

  /// `claim` outlives it. What to subscribe to is its life_topic().
  explicit ValueClaim(const NodeClaim& claim) : claim_(claim) {}

  /// The connection for values was made.
  void connected() { is_connected_ = true; }
  /// It was lost.
  void disconnected();
  /// The life of the node, over this connection.
  void take(const Message& life);
  /// To be called after these, and after each change of the claim. True when values may be
  /// published from now on: the broker may have none of this gateway.
  bool update();
  /// Whether values may be published.
  [[nodiscard]] bool allows() const { return allows_; }
  /// True at most once in a second while the claim holds the node, and another gateway's life was
  /// the last one that arrived: this gateway should publish its own again.
  bool wants_life(Clock::time_point now);

 private:
  const NodeClaim& claim_;
  bool is_connected_ = false;
  bool other_is_up_ = false;
  bool allows_ = false;
  Clock::time_point wanted_{};
};

}  // namespace rr::gateway
