// SPDX-License-Identifier: Apache-2.0
#include "examples/dual_arm/cpp/robot.hpp"

#include <algorithm>
#include <cmath>
#include <numbers>
#include <utility>

namespace dual_arm {

using rr::realtime::Cycle;
using rr::realtime::Nanoseconds;

namespace {

constexpr Nanoseconds cycle_time = std::chrono::milliseconds(1);

}  // namespace

Robot::Robot(const Route& route) {
  for (std::size_t i = 0; i < node_count; ++i) {
    nodes_[i] = std::make_unique<ArmNode>();
    nodes_[i]->connect(route(coordinator_.port(i)));
    coordinator_.connect(i, route(nodes_[i]->port()));
  }
}

SimulatedRun::SimulatedRun(Robot& robot, std::function<void(Nanoseconds)> between) {
  lockstep_.add(cycle_time,
                [&robot](const Cycle& cycle) { robot.coordinator().step(cycle, cycle.due); });
  if (between) {
    lockstep_.add(cycle_time,
                  [between = std::move(between)](const Cycle& cycle) { between(cycle.due); });
  }
  for (std::size_t i = 0; i < node_count; ++i) {
    lockstep_.add(cycle_time,
                  [&robot, i](const Cycle& cycle) { robot.node(i).step(cycle, cycle.due); });
  }
}

TimedRun::TimedRun(Robot& robot) {
  start([&robot](const Cycle& cycle, Nanoseconds now) { robot.coordinator().step(cycle, now); });
  for (std::size_t i = 0; i < node_count; ++i) {
    start([&robot, i](const Cycle& cycle, Nanoseconds now) { robot.node(i).step(cycle, now); });
  }
}

void TimedRun::start(std::function<void(const Cycle&, Nanoseconds)> step) {
  loops_.push_back(std::make_unique<rr::realtime::CyclicLoop>(cycle_time, clock_));
  threads_.emplace_back([this, &loop = *loops_.back(), step = std::move(step)] {
    loop.run([&](const Cycle& cycle) { step(cycle, clock_.now()); });
  });
}

TimedRun::~TimedRun() {
  for (const auto& loop : loops_) loop->stop();
  for (std::thread& thread : threads_) thread.join();
}

std::vector<double> figure(double seconds, std::size_t rows) {
  std::vector<double> table;
  for (std::size_t i = 0; i < rows; ++i) {
    const double part = static_cast<double>(i) / static_cast<double>(rows - 1);
    // Slow at both ends.
    const double phase = 2 * std::numbers::pi *
                         (part - std::sin(2 * std::numbers::pi * part) / (2 * std::numbers::pi));
    table.push_back(part * seconds);
    for (std::size_t axis = 0; axis < axis_count; ++axis) {
      const bool is_right = axis >= 6 && axis < 12;
      const double size = axis >= 12 ? 0.2 : 0.6 / (1.0 + static_cast<double>(axis % 6));
      const double turns = axis % 2 == 0 ? 1 : 2;
      table.push_back((is_right ? -size : size) * std::sin(turns * phase));
    }
  }
  return table;
}

std::vector<std::array<double, axis_count>> computed(const std::vector<double>& rows,
                                                     std::size_t cycles) {
  constexpr std::size_t width = axis_count + 1;
  const std::size_t row_count = rows.size() / width;
  std::array<Joint, axis_count> joints{};
  std::vector<std::array<double, axis_count>> result;
  std::size_t row = 0;
  for (std::size_t i = 0; i < cycles; ++i) {
    const double time = static_cast<double>(i) * period;
    while (row + 2 < row_count && rows[(row + 1) * width] <= time) ++row;
    const double* const low = rows.data() + row * width;
    const double* const high = low + width;
    const double part = std::clamp((time - low[0]) / (high[0] - low[0]), 0.0, 1.0);
    auto& positions = result.emplace_back();
    for (std::size_t axis = 0; axis < axis_count; ++axis) {
      joints[axis].step(low[axis + 1] + part * (high[axis + 1] - low[axis + 1]));
      positions[axis] = joints[axis].position;
    }
  }
  return result;
}

}  // namespace dual_arm
