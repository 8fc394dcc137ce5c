// SPDX-License-Identifier: Apache-2.0
// The robot against what is computed without packets: in step on a simulated clock, with lines that
// lose packets, and on the machine's clock.
#include <gtest/gtest.h>

#include <algorithm>
#include <atomic>
#include <chrono>
#include <cmath>
#include <memory>
#include <thread>
#include <vector>

#include "examples/dual_arm/c/arm_node.h"
#include "examples/dual_arm/cpp/host.hpp"
#include "rr/node.hpp"
#include "runtime/cpp/src/realtime/testing/bad_line.hpp"

namespace dual_arm {
namespace {

using namespace std::chrono_literals;
using rr::realtime::testing::LineFaults;
using rr::realtime::testing::UdpProxy;

constexpr std::size_t row_count = 201;
constexpr double table_seconds = 2;
constexpr std::size_t cycles = 2100;

void follow(Robot& robot, const std::vector<double>& rows) {
  std::vector<double> times;
  std::vector<double> positions;
  for (std::size_t i = 0; i < row_count; ++i) {
    const double* const row = rows.data() + i * (axis_count + 1);
    times.push_back(row[0]);
    positions.insert(positions.end(), row + 1, row + 1 + axis_count);
  }
  robot.coordinator().table().load(times, positions);
  robot.coordinator().orders().set({.mode = 1});
}

/// Largest difference of an axis in lockstep, with these lines between all nodes.
double difference(const LineFaults& faults, std::uint64_t* lost = nullptr) {
  std::vector<std::unique_ptr<UdpProxy>> proxies;
  std::uint32_t seed = 100;
  Robot robot([&](std::uint16_t port) {
    proxies.push_back(std::make_unique<UdpProxy>(faults, ++seed, port));
    return proxies.back()->port();
  });
  const auto rows = figure(table_seconds, row_count);
  follow(robot, rows);
  SimulatedRun run(robot, [&](rr::realtime::Nanoseconds now) {
    for (const auto& proxy : proxies) proxy->move(now);
  });
  const auto expected = computed(rows, cycles);
  double largest = 0;
  for (std::size_t i = 0; i < cycles; ++i) {
    run.run_for(1ms);
    // Positions come one cycle later: what is seen in cycle i + 2 was reached in cycle i, since
    // states wait for the proxies of the next millisecond, and then for the coordinator.
    if (i < 2) continue;
    const auto state = robot.coordinator().state().read();
    for (std::size_t axis = 0; axis < axis_count; ++axis) {
      largest = std::max(largest, std::abs(state.position[axis] - expected[i - 2][axis]));
    }
  }
  for (std::size_t i = 0; lost != nullptr && i < node_count; ++i) {
    *lost += robot.coordinator().counts(i).lost + robot.node(i).counts().lost;
  }
  return largest;
}

TEST(DualArm, WithoutLossTheArmsMoveAsIsComputed) {
  std::uint64_t lost = 0;
  EXPECT_LE(difference({}, &lost), 1e-9);
  EXPECT_EQ(lost, 0U);
}

TEST(DualArm, WithoutAnythingBetweenTooAndTheMovementIsLarge) {
  Robot robot;
  const auto rows = figure(table_seconds, row_count);
  follow(robot, rows);
  SimulatedRun run(robot);
  const auto expected = computed(rows, cycles);
  double largest = 0;
  double farthest = 0;
  for (std::size_t i = 0; i < cycles; ++i) {
    run.run_for(1ms);
    if (i == 0) continue;
    const auto state = robot.coordinator().state().read();
    for (std::size_t axis = 0; axis < axis_count; ++axis) {
      largest = std::max(largest, std::abs(state.position[axis] - expected[i - 1][axis]));
      farthest = std::max(farthest, std::abs(state.position[axis]));
    }
  }
  EXPECT_LE(largest, 1e-9);
  EXPECT_GT(farthest, 0.5);
}

TEST(DualArm, AGamepadThatIsSilentForASecondIsLetGo) {
  Robot robot;
  SimulatedRun run(robot);
  robot.coordinator().orders().set({.mode = 2, .gamepad = {.sticks = {1, 0, 0, 0}}});
  run.run_for(3s);
  EXPECT_NEAR(robot.coordinator().state().read().target[0], 0.5, 1e-9) << "0.5 rad/s for a second";
}

TEST(DualArm, SignalsAreReadAndSetByNameOverTheNetwork) {
  Robot robot;
  rr::Node server;
  rr::Node client;
  const auto host = std::make_shared<Host>(robot);
  const auto service = server.register_service("DualArm", host);
  const auto port = server.listen_tcp(0, "127.0.0.1");
  const auto stub = client.connect<wire::DualArmStub>("rr+tcp://127.0.0.1:" + std::to_string(port) +
                                                      "?service=DualArm");
  SimulatedRun run(robot);
  EXPECT_EQ(stub->signal_names()->size(), 8U);
  stub->write_signal("orders.mode", {2});
  stub->write_signal("orders.gamepad.sticks", {0, 0, 0, -1});
  run.run_for(100ms);
  const auto target = stub->read_signal("state.target");
  ASSERT_EQ(target.size(), axis_count);
  EXPECT_NEAR(target[7], -0.05, 1e-9);
  EXPECT_EQ(stub->read_signal("state.mode")[0], 2);
  EXPECT_THROW(stub->write_signal("state.mode", {1}), rr::Error);
  EXPECT_THROW(stub->write_signal("orders.mode", {256}), rr::Error);
  EXPECT_THROW((void)stub->read_signal("orders.speed"), rr::Error);
}

// The figure's axes move by at most 4 rad/s: a packet that is missing is 4 mrad of older data. Six
// in a row are one in a million, at 10 %.
TEST(DualArm, LossMakesTheStateOlderAndNothingElse) {
  std::uint64_t lost = 0;
  EXPECT_LE(difference({.loss = 0.1}, &lost), 0.025);
  EXPECT_NEAR(static_cast<double>(lost), 0.1 * 6 * cycles, 0.03 * 6 * cycles);
  EXPECT_LE(difference({.loss = 0.3, .duplicates = 0.1, .reordered = 0.1}), 0.05);
}

/// The same node in C, by what `robdef generate --lang cbus` makes of the definition.
TEST(DualArm, ANodeInPlainCMovesAsTheOthersDo) {
  arm_node plain;
  std::uint16_t port = 0;
  ASSERT_EQ(arm_node_open(&plain, &port), 0);
  Robot robot;
  robot.coordinator().connect(2, port);
  arm_node_connect(&plain, robot.coordinator().port(2));
  const auto rows = figure(table_seconds, row_count);
  follow(robot, rows);
  rr::realtime::Lockstep lockstep;
  lockstep.add(1ms, [&](const rr::realtime::Cycle& cycle) {
    robot.coordinator().step(cycle, cycle.due);
    robot.node(0).step(cycle, cycle.due);
    robot.node(1).step(cycle, cycle.due);
    arm_node_step(&plain, cycle.number, cycle.due.count());
  });
  const auto expected = computed(rows, cycles);
  double largest = 0;
  for (std::size_t i = 0; i < cycles; ++i) {
    lockstep.run_until(lockstep.clock().now() + 1ms);
    if (i == 0) continue;
    const auto state = robot.coordinator().state().read();
    for (std::size_t axis = 0; axis < axis_count; ++axis) {
      largest = std::max(largest, std::abs(state.position[axis] - expected[i - 1][axis]));
    }
  }
  arm_node_close(&plain);
  EXPECT_LE(largest, 1e-9);
  EXPECT_EQ(robot.coordinator().counts(2).accepted, cycles - 1);
}

TEST(DualArm, AStallOfFiftyMillisecondsIsHeldAndCaughtUpWith) {
  const double during = difference({.stall_begin = 500ms, .stall_length = 50ms});
  EXPECT_GT(during, 0.01);
  EXPECT_LE(during, 0.25);
}

/// On the machine's clock: how far an axis was from what is computed for its coordinator's sample,
/// and how long something was late that it depends on.
struct Outcome {
  double difference = 0;
  rr::realtime::Nanoseconds delay{0};
};

Outcome timed_outcome(const LineFaults& faults) {
  std::vector<std::unique_ptr<UdpProxy>> proxies;
  std::uint32_t seed = 200;
  Robot robot([&](std::uint16_t port) {
    proxies.push_back(std::make_unique<UdpProxy>(faults, ++seed, port));
    return proxies.back()->port();
  });
  const auto rows = figure(table_seconds, row_count);
  follow(robot, rows);
  const auto expected = computed(rows, 10 * cycles);
  Outcome outcome;
  std::atomic<bool> is_over{false};
  rr::realtime::Nanoseconds line_delay{0};
  std::thread line([&] {
    rr::realtime::SteadyClock clock;
    for (auto before = clock.now(); !is_over;) {
      for (const auto& proxy : proxies) proxy->move(0ns);
      std::this_thread::sleep_for(200us);
      line_delay = std::max(line_delay, clock.now() - before);
      before = clock.now();
    }
  });
  {
    TimedRun run(robot);
    for (std::uint64_t sample = 0; sample < cycles;) {
      std::this_thread::sleep_for(5ms);
      const auto state = robot.coordinator().state().read();
      sample = state.sample;
      for (std::size_t axis = 0; axis < axis_count && sample < expected.size(); ++axis) {
        outcome.difference =
            std::max(outcome.difference, std::abs(state.position[axis] - expected[sample][axis]));
      }
    }
    for (std::size_t i = 0; i <= node_count; ++i) {
      const auto& counts = run.counts(i);
      outcome.delay =
          std::max(outcome.delay, counts.lateness.largest() + counts.duration.largest());
    }
  }
  is_over = true;
  line.join();
  outcome.delay += line_delay;
  return outcome;
}

// An axis turns by 4 rad/s at most. Commands and states are late by what their loops and the line
// are late, there and back, and by some lost packets in a row: 20 ms are for those.
TEST(DualArm, OnTheMachinesClockItStaysAsNearAsItsLoopsAreInTime) {
  for (const double loss : {0.0, 0.1}) {
    const Outcome outcome = timed_outcome({.loss = loss});
    const double delay = std::chrono::duration<double>(20ms + 2 * outcome.delay).count();
    EXPECT_LE(outcome.difference, 4 * delay);
  }
}

}  // namespace
}  // namespace dual_arm
