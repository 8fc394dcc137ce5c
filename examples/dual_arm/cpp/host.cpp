// SPDX-License-Identifier: Apache-2.0
#include "examples/dual_arm/cpp/host.hpp"

#include "rr/error.hpp"

namespace dual_arm {

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
