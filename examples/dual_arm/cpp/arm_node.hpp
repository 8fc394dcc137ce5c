// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <array>
#include <cstdint>

#include "examples/dual_arm/cpp/joint.hpp"
#include "experimental/dual_arm.hpp"
#include "rr/realtime/state_channel.hpp"

namespace dual_arm {

namespace wire = experimental::dual_arm;

/// How long a command or a state counts.
inline constexpr rr::realtime::Nanoseconds lifespan = std::chrono::milliseconds(5);

/// A real-time node: six simulated axes that go where the newest command says. When none has come
/// for `lifespan`, they stay at the last target.
class ArmNode {
 public:
  /// Sends to nobody until connect().
  ArmNode();
  /// Where commands are to be sent to.
  [[nodiscard]] std::uint16_t port() const { return in_.port(); }
  /// Sends its state there.
  void connect(std::uint16_t port) { out_.connect("127.0.0.1", port); }
  /// One cycle: what the loop calls. Allocates nothing.
  void step(const rr::realtime::Cycle& cycle, rr::realtime::Nanoseconds now);
  [[nodiscard]] const rr::realtime::ReceiveCounts& counts() const { return receiver_.counts(); }

 private:
  rr::realtime::UdpSocket in_{"127.0.0.1", 0};
  rr::realtime::UdpSocket out_{"127.0.0.1", 0};
  rr::realtime::StateReceiver<wire::NodeCommand> receiver_;
  rr::realtime::StateSender<wire::NodeState> sender_;
  std::array<Joint, 6> joints_{};
  std::array<double, 6> target_{};
  std::uint64_t next_sample_ = 0;
};

}  // namespace dual_arm
