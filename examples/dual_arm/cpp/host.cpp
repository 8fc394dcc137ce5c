// SPDX-License-Identifier: Apache-2.0
#include "examples/dual_arm/cpp/host.hpp"

#include <cstddef>

#include "rr/error.hpp"

namespace dual_arm {

namespace {

// Orders are of this program alone, so their layout is written down.
rr::realtime::Layout layout_of_orders() {
  using rr::realtime::SignalType;
  constexpr std::size_t gamepad = offsetof(Orders, gamepad);
  static constexpr rr::realtime::SignalEntry entries[] = {
      {"mode", SignalType::uint8, 1, offsetof(Orders, mode)},
      {"gamepad.sticks", SignalType::double_, 4, gamepad + offsetof(wire::Gamepad, sticks)},
      {"gamepad.buttons", SignalType::uint8, 1, gamepad + offsetof(wire::Gamepad, buttons)}};
  return {"dual_arm.Orders", entries, sizeof(Orders)};
}

}  // namespace

Host::Host(Robot& robot)
    : robot_(robot),
      table_(std::make_shared<rr::realtime::TableMemory>(robot.coordinator().table())) {
  bus_.add("state", rr::realtime::layout_of<wire::RobotState>(), robot.coordinator().state());
  bus_.add("orders", layout_of_orders(), robot.coordinator().orders());
}

std::optional<std::vector<std::string>> Host::signal_names() { return bus_.signal_names(); }

rr::Array<double> Host::read_signal(const std::string& name) {
  const std::vector<double> values = bus_.get(name);
  return rr::Array<double>(std::span<const double>(values));
}

void Host::write_signal(const std::string& name, const rr::Array<double>& values) {
  bus_.set(name, std::vector<double>(values.begin(), values.end()));
}

void Host::join(rr::realtime::BusService& bus) {
  bus.publish(robot_.coordinator().state(), state());
  gamepad().on_out([this](const wire::Gamepad& value, const rr::TimeSpec&, std::uint32_t) {
    robot_.coordinator().orders().update([&](Orders& orders) { orders.gamepad = value; });
  });
}

std::uint64_t Host::follow_table(std::uint32_t rows, std::uint64_t at_sample) {
  return table_->load(rows, at_sample);
}

void Host::change_mode(std::uint8_t mode) {
  if (mode > 2) {
    throw rr::Error(rr::ErrorCode::invalid_argument, "modes are 0, 1 and 2");
  }
  robot_.coordinator().orders().update([&](Orders& orders) { orders.mode = mode; });
}

rr::Array<double> Host::link_counts(std::uint32_t node) {
  if (node >= node_count) {
    throw rr::Error(rr::ErrorCode::out_of_range, "nodes are counted from 0 to 2");
  }
  const auto& counts = robot_.coordinator().counts(node);
  const auto number = [](const auto& count) { return static_cast<double>(count.load()); };
  return {number(counts.accepted), number(counts.lost), number(counts.late),
          number(counts.duplicates)};
}

}  // namespace dual_arm
