// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <array>
#include <cstdint>
#include <memory>

#include "examples/dual_arm/cpp/arm_node.hpp"
#include "rr/realtime/lookup_table.hpp"
#include "rr/realtime/state_bus.hpp"

namespace dual_arm {

inline constexpr std::size_t node_count = 3;
inline constexpr std::size_t axis_count = 18;

/// What is set from outside.
struct Orders {
  std::uint8_t mode = 0;  ///< 0 holds, 1 follows the table, 2 follows the gamepad
  wire::Gamepad gamepad{};
};

/// The fourth real-time node: makes the targets of all axes, and gathers where they are.
class Coordinator {
 public:
  Coordinator();

  /// Where a node's states are to be sent to.
  [[nodiscard]] std::uint16_t port(std::size_t node) const { return links_[node]->in.port(); }
  /// Sends commands there.
  void connect(std::size_t node, std::uint16_t port) {
    links_[node]->out.connect("127.0.0.1", port);
  }
  /// One cycle: what the loop calls. Allocates nothing.
  void step(const rr::realtime::Cycle& cycle, rr::realtime::Nanoseconds now);

  // For everybody else.
  [[nodiscard]] rr::realtime::LookupTable& table() { return table_; }
  [[nodiscard]] rr::realtime::CommandGroup<Orders>& orders() { return orders_; }
  [[nodiscard]] const rr::realtime::SignalGroup<wire::RobotState>& state() const { return state_; }
  [[nodiscard]] const rr::realtime::ReceiveCounts& counts(std::size_t node) const {
    return links_.at(node)->receiver.counts();
  }

 private:
  struct Link {
    Link();
    rr::realtime::UdpSocket in{"127.0.0.1", 0};
    rr::realtime::UdpSocket out{"127.0.0.1", 0};
    rr::realtime::StateReceiver<wire::NodeState> receiver;
    rr::realtime::StateSender<wire::NodeCommand> sender;
  };
  void make_targets(std::uint64_t sample);

  std::array<std::unique_ptr<Link>, node_count> links_;
  rr::realtime::LookupTable table_{axis_count, 2000};
  rr::realtime::CommandGroup<Orders> orders_;
  rr::realtime::SignalGroup<wire::RobotState> state_;
  std::array<double, axis_count> targets_{};
  std::uint64_t table_begin_ = 0;  // sample
  std::uint64_t silence_ = 0;      // cycles since the last order
  wire::RobotState now_{};
};

}  // namespace dual_arm
