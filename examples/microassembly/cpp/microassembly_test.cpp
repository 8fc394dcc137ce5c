// SPDX-License-Identifier: Apache-2.0
#include <gtest/gtest.h>

#include <cmath>

#include "examples/microassembly/cpp/cell.hpp"
#include "rr/realtime/lockstep.hpp"

namespace microassembly {
namespace {

using namespace std::chrono_literals;

struct World {
  Node node;
  rr::realtime::Lockstep lockstep;

  World() {
    lockstep.add(1ms, [this](const rr::realtime::Cycle& cycle) { node.step(cycle); });
  }
  wire::AxesState after(rr::realtime::Nanoseconds time) {
    lockstep.run_until(lockstep.clock().now() + time);
    return node.state().read();
  }
};

TEST(Microassembly, ThePartGoesWithTheStageUntilItIsHeldAndThenWithTheProbes) {
  World world;
  rr::realtime::TableMemory memory(world.node.table());
  const auto rows = assembly();
  memory.write(0, rows);
  memory.load(rows.size() / 16);
  EXPECT_NEAR(world.after(800ms).part[0], 80, 0.1) << "the stage has brought it";
  const auto lifted = world.after(1100ms);
  EXPECT_TRUE(lifted.is_gripped);
  EXPECT_NEAR(tip(lifted, 0)[2], 120, 3);
  const auto end = world.after(2100ms);
  EXPECT_FALSE(end.is_gripped);
  EXPECT_FALSE(end.is_moving);
  EXPECT_NEAR(end.part[0], 230, 2) << "carried by 150 um";
}

TEST(Microassembly, CoarseAxesGoInStepsAndFineOnesHaveTheirReach) {
  World world;
  wire::AxesTarget target;
  target.position[0] = 100.4;
  target.position[3] = 100;
  target.position[12] = 3.1;
  world.node.target().set(target);
  const auto state = world.after(300ms);
  EXPECT_EQ(state.position[0], 100.0) << "80 steps of 1.25 um";
  EXPECT_NEAR(state.position[3], 20, 0.01);
  EXPECT_NEAR(state.position[12], 3.1, 1e-9);
}

TEST(Microassembly, CamerasShowWhatIsThereAndNeedLight) {
  World world;
  const auto state = world.after(1ms);
  const auto bright = look(state, 0, 1);
  const auto dark = look(state, 0, 0);
  EXPECT_EQ(bright.at(picture_width / 2, picture_height / 2), (drawing::Color{190, 120, 40}));
  EXPECT_EQ(dark.at(picture_width / 2, picture_height / 2), drawing::black);
}

}  // namespace
}  // namespace microassembly
