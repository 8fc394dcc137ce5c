// SPDX-License-Identifier: Apache-2.0
// A loop as a service: its signals as wires, commands as functions and wires, its table as a
// memory.
#include "rr/realtime/service.hpp"

#include <gtest/gtest.h>

#include <memory>
#include <vector>

#include "experimental/arm.hpp"
#include "rr/node.hpp"
#include "rr/realtime/lockstep.hpp"
#include "runtime/cpp/src/node/testing/pair.hpp"

namespace rr::realtime {
namespace {

using namespace std::chrono_literals;
namespace arm = experimental::arm;
using rr::testing::eventually;

/// A loop that goes to where its table says, and says where it is.
struct ArmLoop {
  SignalGroup<arm::State> state;
  CommandGroup<arm::Command> command;
  LookupTable table{1, 100};
  arm::State now{};

  void step(std::uint64_t sample) {
    command.take();
    table.begin_sample(sample);
    std::array<double, 1> position{command.value().target[0]};
    table.read(static_cast<double>(sample), position);
    now.sample = sample;
    now.mode = command.value().mode;
    now.joints[0].angle = position[0];
    state.write(now);
  }
};

class ArmObject final : public arm::ArmDefault {
 public:
  explicit ArmObject(ArmLoop& loop) : memory_(std::make_shared<TableMemory>(loop.table)) {}

  std::shared_ptr<rr::ArrayMemorySource<double>> table() override { return memory_; }
  void start() override { memory_->load(3, 10); }

 private:
  std::shared_ptr<TableMemory> memory_;
};

struct Served {
  ArmLoop loop;
  std::shared_ptr<ArmObject> object = std::make_shared<ArmObject>(loop);
  rr::Node server;
  rr::Node client;
  rr::Service service = server.register_service("arm", object);
  std::uint16_t port = server.listen_tcp(0, "127.0.0.1");
  BusService bus{1ms};
  rr::Client<arm::ArmStub> stub =
      client.connect<arm::ArmStub>("rr+tcp://127.0.0.1:" + std::to_string(port) + "?service=arm");

  Served() {
    bus.publish(loop.state, object->state());
    BusService::accept(object->command(), loop.command);
  }
};

TEST(RealtimeService, SignalsComeByWireAndByPeek) {
  Served served;
  auto wire = served.stub->state().connect();
  served.loop.step(41);
  EXPECT_TRUE(eventually([&] {
    const auto value = wire.try_in();
    return value && value->value.sample == 41;
  }));
  served.loop.step(42);
  EXPECT_EQ(served.stub->state().peek_in().value.sample, 42U);
}

TEST(RealtimeService, ACommandSetsTheLoopAndIsSeenInTheBus) {
  Served served;
  served.stub->command().poke_out({.mode = 3, .target = {0.5}});
  served.loop.step(1);
  const auto state = served.stub->state().peek_in().value;
  EXPECT_EQ(state.mode, 3);
  EXPECT_EQ(state.joints[0].angle, 0.5);

  StateBus bus;
  bus.add("command", layout_of<arm::Command>(), served.loop.command);
  bus.set("command.mode", 4);
  served.loop.step(2);
  EXPECT_EQ(served.stub->state().peek_in().value.mode, 4);
  EXPECT_EQ(served.stub->command().peek_out().value.mode, 4);
}

TEST(RealtimeService, ATableIsWrittenToMemoryAndFollowedFromItsSampleOn) {
  Served served;
  const std::vector<double> rows{0, 1, 10, 2, 20, 4};
  served.stub->table().write(0, rows);
  served.loop.step(9);
  EXPECT_EQ(served.loop.now.joints[0].angle, 0) << "written, but not loaded";
  served.stub->start();
  served.loop.step(9);
  EXPECT_EQ(served.loop.now.joints[0].angle, 0) << "not its sample yet";
  served.loop.step(10);
  EXPECT_EQ(served.loop.now.joints[0].angle, 2);
  served.loop.step(15);
  EXPECT_EQ(served.loop.now.joints[0].angle, 3);
}

TEST(RealtimeService, ATableThatIsWrongIsRefusedAtTheCall) {
  Served served;
  const std::vector<double> rows{0, 1, 10, 2, 5, 4};
  served.stub->table().write(0, rows);
  EXPECT_EQ(rr::testing::error_of([&] { served.stub->start(); }).code(),
            ErrorCode::invalid_argument);
}

TEST(RealtimeService, WhatIsNoPodHasNoLayout) {
  EXPECT_THROW((void)layout_of(type_of<double>), Error);
  EXPECT_THROW((void)layout_of(type_of<experimental::motion::Vector3>), Error);
}

}  // namespace
}  // namespace rr::realtime
