// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <memory>
#include <optional>
#include <string>
#include <vector>

#include "examples/dual_arm/cpp/robot.hpp"
#include "rr/realtime/service.hpp"

namespace dual_arm {

/// The host: offers the robot as one object. Nothing here runs in a loop's thread.
class Host final : public wire::DualArmDefault {
 public:
  /// The robot lives longer.
  explicit Host(Robot& robot);

  /// Once it is offered: joins its wires to the robot's bus, for as long as both live.
  void join(rr::realtime::BusService& bus);

  std::shared_ptr<rr::ArrayMemorySource<double>> table() override { return table_; }
  std::uint64_t follow_table(std::uint32_t rows, std::uint64_t at_sample) override;
  void change_mode(std::uint8_t mode) override;
  std::optional<std::vector<std::string>> signal_names() override;
  rr::Array<double> read_signal(const std::string& name) override;
  void write_signal(const std::string& name, const rr::Array<double>& values) override;
  rr::Array<double> link_counts(std::uint32_t node) override;

 private:
  Robot& robot_;
  std::shared_ptr<rr::realtime::TableMemory> table_;
  rr::realtime::StateBus bus_;
};

}  // namespace dual_arm
