// SPDX-License-Identifier: Apache-2.0
#include "examples/smart_room/cpp/room.hpp"

#include <gtest/gtest.h>

#include <stdexcept>

namespace smart_room {
namespace {

TEST(Room, SetsARangeOfLightsCountedFromOne) {
  Room room;
  room.set_lights(1, 2, {0.7, 0.3, 0});
  const auto lights = room.lights();
  EXPECT_EQ(lights[0], (Color{0.7, 0.3, 0}));
  EXPECT_EQ(lights[1], (Color{0.7, 0.3, 0}));
  EXPECT_EQ(lights[2], (Color{0.4, 0.4, 0.4}));
}

TEST(Room, RefusesLightsThatAreNotThere) {
  Room room;
  EXPECT_THROW(room.set_lights(0, 2, {}), std::out_of_range);
  EXPECT_THROW(room.set_lights(3, 2, {}), std::out_of_range);
  EXPECT_THROW(room.set_lights(1, Room::light_count + 1, {}), std::out_of_range);
}

TEST(Room, ASensorBelowALampFollowsItsColor) {
  Room room;
  room.set_lights(1, Room::light_count, {});
  EXPECT_EQ(room.sensor(0), Color{});
  room.set_lights(1, 1, {1, 0, 0});
  EXPECT_GT(room.sensor(0).red, 10 * room.sensor(3).red);
  EXPECT_GT(room.sensor(3).red, 0);
  EXPECT_EQ(room.sensor(0).green, 0);
}

TEST(Room, PicturesShowTheLightsAndNothingElseChangesThem) {
  Room room;
  const Picture before = room.picture(2);
  EXPECT_EQ(before.rgb.size(), 3U * 320 * 240);
  EXPECT_EQ(before.rgb, room.picture(2).rgb);
  room.set_lights(1, 1, {1, 0, 0});
  const Picture after = room.picture(2);
  const std::size_t middle = 3 * (120 * 320 + 120);
  EXPECT_GT(after.rgb[middle], before.rgb[middle]);
  EXPECT_LT(after.rgb[middle + 2], before.rgb[middle + 2]);
}

}  // namespace
}  // namespace smart_room
