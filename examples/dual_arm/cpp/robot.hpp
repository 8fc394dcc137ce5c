// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <array>
#include <functional>
#include <memory>
#include <thread>
#include <vector>

#include "examples/dual_arm/cpp/coordinator.hpp"
#include "rr/realtime/cyclic_loop.hpp"
#include "rr/realtime/lockstep.hpp"

namespace dual_arm {

/// The four real-time nodes, connected by UDP.
class Robot {
 public:
  /// Where packets for a port go, instead: a test puts something in between.
  using Route = std::function<std::uint16_t(std::uint16_t port)>;
  explicit Robot(const Route& route = [](std::uint16_t port) { return port; });

  [[nodiscard]] Coordinator& coordinator() { return coordinator_; }
  [[nodiscard]] ArmNode& node(std::size_t index) { return *nodes_[index]; }

 private:
  Coordinator coordinator_;
  std::array<std::unique_ptr<ArmNode>, node_count> nodes_;
};

/// Runs a robot on a simulated clock, as fast as it goes: coordinator, what lies `between`, nodes,
/// in this order in each millisecond.
class SimulatedRun {
 public:
  explicit SimulatedRun(Robot& robot, std::function<void(rr::realtime::Nanoseconds)> between = {});
  void run_for(rr::realtime::Nanoseconds time) {
    lockstep_.run_until(lockstep_.clock().now() + time);
  }

 private:
  rr::realtime::Lockstep lockstep_;
};

/// Runs it on the machine's clock, each node in a thread of its own, until it ends.
class TimedRun {
 public:
  explicit TimedRun(Robot& robot);
  ~TimedRun();
  TimedRun(const TimedRun&) = delete;
  TimedRun& operator=(const TimedRun&) = delete;
  /// Of the coordinator and the nodes.
  [[nodiscard]] const rr::realtime::LoopCounts& counts(std::size_t loop) const {
    return loops_[loop]->counts();
  }

 private:
  void start(std::function<void(const rr::realtime::Cycle&, rr::realtime::Nanoseconds)> step);

  rr::realtime::SteadyClock clock_;
  std::vector<std::unique_ptr<rr::realtime::CyclicLoop>> loops_;
  std::vector<std::thread> threads_;
};

/// Rows of a time and 18 positions: both arms draw an eight beside each other, the bases go back
/// and forth. Begins and ends at zero.
std::vector<double> figure(double seconds, std::size_t rows);

/// What the robot would do with this table from its sample 0 on, without packets: the positions of
/// all axes at the end of each of so many cycles.
std::vector<std::array<double, axis_count>> computed(const std::vector<double>& rows,
                                                     std::size_t cycles);

}  // namespace dual_arm
