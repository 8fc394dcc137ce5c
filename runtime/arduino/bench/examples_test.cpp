// SPDX-License-Identifier: Apache-2.0
// The sketches of the library's examples, on simulated boards.
#include <gtest/gtest.h>

#include <cstring>

#include "runtime/arduino/bench/elf_dir.hpp"
#include "runtime/arduino/bench/simulated_line.hpp"

namespace rr::serial::testing {
namespace {

using namespace std::chrono_literals;

// Compare registers of the pins 9, 10 (low bytes) and 11, and where pin 9's output is switched on.
constexpr std::uint16_t red_register = 0x88;
constexpr std::uint16_t green_register = 0x8A;
constexpr std::uint16_t blue_register = 0xB3;

std::vector<std::uint8_t> with_floats(std::vector<std::uint8_t> body,
                                      std::initializer_list<float> values) {
  for (const float value : values) {
    const std::size_t at = body.size();
    body.resize(at + sizeof value);
    std::memcpy(body.data() + at, &value, sizeof value);
  }
  return body;
}

TEST(LightBoard, ShowsColoursAndSeesLight) {
  SimulatedLine line(elf_dir + "light.elf", 115200);
  line.board.set_voltage(0, 2.5);
  ASSERT_EQ(line.hello().kind, Outcome::Kind::reply);
  EXPECT_EQ(line.text(0), "Light example.light.Light");
  ASSERT_EQ(line.ask(Kind::Set, with_floats({0, 0}, {0.7F, 0.3F, 0.1F})).kind,
            Outcome::Kind::reply);
  EXPECT_EQ(line.board.peek(red_register), 178);
  EXPECT_EQ(line.board.peek(green_register), 76);
  EXPECT_EQ(line.board.peek(blue_register), 25);
  const Outcome refused = line.ask(Kind::Set, with_floats({0, 0}, {0.7F, 1.3F, 0.1F}));
  EXPECT_EQ(refused.kind, Outcome::Kind::error);
  EXPECT_EQ(refused.code, 29);
  const Outcome light = line.ask(Kind::Get, {0, 1});
  ASSERT_EQ(light.kind, Outcome::Kind::reply);
  EXPECT_NEAR(double_in(light.body, 1), 255.5, 1);
}

TEST(LightBoard, TellsWhenAFadeHasEnded) {
  SimulatedLine line(elf_dir + "light.elf", 115200);
  ASSERT_EQ(line.hello().kind, Outcome::Kind::reply);
  std::vector<std::uint8_t> body = with_floats({0, 2}, {1, 0.5F, 0.25F});
  const auto duration = bytes_of_double(0.2);
  body.insert(body.end(), duration.begin(), duration.end());
  ASSERT_EQ(line.ask(Kind::Call, body).kind, Outcome::Kind::reply);
  line.run(100ms);
  EXPECT_TRUE(line.unasked.empty());
  EXPECT_NEAR(line.board.peek(green_register), 64, 8);
  line.run(130ms);
  ASSERT_EQ(line.unasked.size(), 1U);
  EXPECT_EQ(line.unasked[0].kind, Kind::Event);
  EXPECT_EQ(line.unasked[0].body, with_floats({0, 3}, {1, 0.5F, 0.25F}));
}

TEST(LightBoard, SendsItsSensorWhileItIsWanted) {
  SimulatedLine line(elf_dir + "light.elf", 115200);
  ASSERT_EQ(line.hello().kind, Outcome::Kind::reply);
  line.run(300ms);
  EXPECT_TRUE(line.unasked.empty());
  line.board.set_voltage(0, 5);
  ASSERT_EQ(line.ask(Kind::Open, {0, 4}).kind, Outcome::Kind::reply);
  line.run(1s);
  EXPECT_NEAR(static_cast<double>(line.unasked.size()), 11, 1);
  ASSERT_FALSE(line.unasked.empty());
  EXPECT_EQ(line.unasked.back().kind, Kind::WireValue);
  EXPECT_NEAR(double_in(line.unasked.back().body, 2), 511.5, 1);
}

TEST(StepperBoard, MovesBetweenItsSwitches) {
  SimulatedLine line(elf_dir + "stepper.elf", 115200);
  line.board.set_pin(4, true);
  line.board.set_pin(5, true);
  ASSERT_EQ(line.hello().kind, Outcome::Kind::reply);
  const std::vector<std::uint8_t> to_hundred{0, 4, 100, 0, 0, 0};
  const Outcome refused = line.ask(Kind::Call, to_hundred);
  EXPECT_EQ(refused.kind, Outcome::Kind::error);
  EXPECT_EQ(refused.code, firstException) << "NotHomed";
  ASSERT_EQ(line.ask(Kind::Call, {0, 3}).kind, Outcome::Kind::reply);
  line.run(100ms);
  line.board.set_pin(4, false);
  line.run(50ms);
  ASSERT_EQ(line.unasked.size(), 1U);
  EXPECT_EQ(line.unasked[0].body, (std::vector<std::uint8_t>{0, 6, 0, 0, 0, 0, 1, 0, 0, 0}));
  line.board.set_pin(4, true);
  ASSERT_EQ(line.ask(Kind::Call, to_hundred).kind, Outcome::Kind::reply);
  line.run(300ms);
  ASSERT_EQ(line.unasked.size(), 2U);
  EXPECT_EQ(line.unasked[1].body, (std::vector<std::uint8_t>{0, 6, 100, 0, 0, 0, 0, 0, 0, 0}));
  ASSERT_EQ(line.ask(Kind::Call, {0, 4, 0xE8, 3, 0, 0}).kind, Outcome::Kind::reply);
  line.run(200ms);
  line.board.set_pin(5, false);
  line.run(50ms);
  ASSERT_EQ(line.unasked.size(), 3U);
  EXPECT_EQ(line.unasked[2].body[6], 2) << "stopped by the high switch";
}

}  // namespace
}  // namespace rr::serial::testing
