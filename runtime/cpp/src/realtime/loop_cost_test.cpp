// SPDX-License-Identifier: Apache-2.0
// What the loop's side costs: no heap, no lock, and of the kernel clock, send and receive only,
// while other threads use the bus.
#include <gtest/gtest.h>

#include <atomic>
#include <memory>
#include <mutex>
#include <new>
#include <thread>
#include <vector>

#include "rr/realtime/cyclic_loop.hpp"
#include "rr/realtime/lookup_table.hpp"
#include "rr/realtime/state_bus.hpp"
#include "rr/realtime/state_channel.hpp"
#include "runtime/cpp/src/realtime/testing/arm_pod.hpp"
#include "runtime/cpp/src/realtime/testing/cost.hpp"

namespace rr::realtime {
namespace {

using namespace std::chrono_literals;
using testing::arm_layout;
using testing::ArmPod;
using testing::Cost;

struct Outcome {
  Cost cost;
  std::atomic<std::uint64_t> cycles{0};
  std::atomic<std::uint64_t> accepted{0};
  std::atomic<std::uint64_t> commands{0};
  std::atomic<std::uint64_t> tables{0};
};

Outcome& make_outcome() { return *::new (testing::shared_memory(sizeof(Outcome))) Outcome; }

/// A loop that uses all there is, with a peer that is itself.
class Node {
 public:
  explicit Node(Outcome& outcome) : outcome_(outcome) {
    socket_.connect("127.0.0.1", socket_.port());
    bus_.add("state", arm_layout(), state_);
    bus_.add("command", arm_layout(), command_);
    user_ = std::thread([this] { use_bus(); });
  }

  void run() {
    loop_.run([this](const Cycle& cycle) { step(cycle); });
    outcome_.cycles = loop_.counts().cycles.load();
    outcome_.accepted = receiver_.counts().accepted.load();
    outcome_.tables = table_.current();
  }

 private:
  void step(const Cycle& cycle) {
    receiver_.poll(socket_, cycle.due);
    if (command_.take()) ++outcome_.commands;
    table_.begin_sample(cycle.number);
    ArmPod pod{.sample = cycle.number};
    table_.read(static_cast<double>(cycle.number), pod.q);
    if (const ArmPod* const newest = receiver_.newest(cycle.due)) pod.mode = newest->mode;
    if (const auto own = state_.try_read()) pod.temperature = own->temperature;
    state_.write(pod);
    sender_.send(pod, cycle.due);
    if (cycle.number >= 300) loop_.stop();
  }
  void use_bus() {
    for (double i = 0;; ++i) {
      bus_.set("command.q", i);
      (void)bus_.get("state.q");
      table_.load(std::vector{0.0, 400.0}, std::vector<double>(12, i));
      std::this_thread::sleep_for(1ms);
    }
  }

  Outcome& outcome_;
  SteadyClock clock_;
  CyclicLoop loop_{1ms, clock_};
  UdpSocket socket_{"127.0.0.1", 0};
  StateSender<ArmPod> sender_{arm_layout(), socket_};
  StateReceiver<ArmPod> receiver_{arm_layout(), 5ms};
  SignalGroup<ArmPod> state_;
  CommandGroup<ArmPod> command_;
  LookupTable table_{6, 10};
  StateBus bus_;
  std::thread user_;  // ends with the process
};

TEST(RealtimeCost, TheLoopNeitherAllocatesNorLocksNorCallsTheKernelButForItsPackets) {
  if (!testing::can_watch()) GTEST_SKIP() << "sanitizers stand in the same place";
  Outcome& outcome = make_outcome();
  testing::watch(outcome.cost, [&]() -> std::function<void()> {
    auto* const node = new Node(outcome);  // its thread uses it until the process ends
    return [node] { node->run(); };
  });
  ASSERT_TRUE(outcome.cost.is_over);
  EXPECT_EQ(outcome.cost.allocations, 0U);
  EXPECT_EQ(outcome.cost.locks, 0U);
  if (!outcome.cost.is_watched) GTEST_SKIP() << "the kernel does not take filters here";
  EXPECT_EQ(outcome.cost.kernel_calls, 0U) << "the last was number " << outcome.cost.last_call;
  EXPECT_GT(outcome.cycles, 20U);
  EXPECT_GT(outcome.accepted, 10U);
  EXPECT_GT(outcome.commands, 0U);
  EXPECT_GT(outcome.tables, 0U);
}

TEST(RealtimeCost, WhatIsWatchedIsCounted) {
  if (!testing::can_watch()) GTEST_SKIP() << "sanitizers stand in the same place";
  Outcome& outcome = make_outcome();
  testing::watch(outcome.cost, [&]() -> std::function<void()> {
    return [] {
      static std::mutex mutex;
      const std::lock_guard lock(mutex);
      std::unique_ptr<int[]> memory(new int[100]);
      static std::atomic<int*> keep;
      keep = memory.get();
      std::this_thread::yield();
    };
  });
  ASSERT_TRUE(outcome.cost.is_over);
  EXPECT_EQ(outcome.cost.allocations, 2U);
  EXPECT_EQ(outcome.cost.locks, 1U);
  EXPECT_EQ(outcome.cost.kernel_calls, outcome.cost.is_watched ? 1U : 0U);
}

}  // namespace
}  // namespace rr::realtime
