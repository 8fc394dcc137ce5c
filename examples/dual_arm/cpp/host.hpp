// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <memory>

#include "examples/dual_arm/cpp/robot.hpp"
#include "rr/realtime/service.hpp"

namespace dual_arm {

/// The host: offers the robot as one object. Nothing here runs in a loop's thread.
class Host final : public wire::DualArmDefault {
 public:
  /// The robot lives longer.
  explicit Host(Robot& robot)
      : robot_(robot),
        table_(std::make_shared<rr::realtime::TableMemory>(robot.coordinator().table())) {}

  /// Once it is offered: joins its wires to the robot's bus, for as long as both live.
  void join(rr::realtime::BusService& bus);

  std::shared_ptr<rr::ArrayMemorySource<double>> table() override { return table_; }
  std::uint64_t follow_table(std::uint32_t rows, std::uint64_t at_sample) override;
  void change_mode(std::uint8_t mode) override;
  rr::Array<double> link_counts(std::uint32_t node) override;

 private:
  Robot& robot_;
  std::shared_ptr<rr::realtime::TableMemory> table_;
};

}  // namespace dual_arm
