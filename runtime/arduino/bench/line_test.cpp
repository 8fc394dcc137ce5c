// SPDX-License-Identifier: Apache-2.0
// The protocol between the real program of a board and the host's end, over good and bad lines.
#include <gtest/gtest.h>

#include <algorithm>
#include <cmath>
#include <cstdlib>
#include <iostream>
#include <limits>
#include <random>
#include <tuple>

#include "runtime/arduino/bench/elf_dir.hpp"
#include "runtime/arduino/bench/simulated_line.hpp"

namespace rr::serial::testing {
namespace {

using namespace std::chrono_literals;

// Members of example.echo.
constexpr std::uint8_t value_member = 0;
constexpr std::uint8_t count_member = 1;
constexpr std::uint8_t add_member = 2;
constexpr std::uint8_t wait_member = 3;

/// Numbers that an AVR holds exactly.
double exact(std::uint32_t number) { return static_cast<double>(number % 0x1000000) / 256; }

std::vector<std::uint8_t> adding(double a, double b) {
  std::vector<std::uint8_t> body{0, add_member};
  for (const double value : {a, b}) {
    const auto bytes = bytes_of_double(value);
    body.insert(body.end(), bytes.begin(), bytes.end());
  }
  return body;
}

std::uint32_t count_of(SimulatedLine& line) {
  const Outcome outcome = line.ask(Kind::Get, {0, count_member});
  if (outcome.kind != Outcome::Kind::reply || outcome.body.size() != 5) return ~0U;
  return static_cast<std::uint32_t>(outcome.body[1] | outcome.body[2] << 8 | outcome.body[3] << 16 |
                                    outcome.body[4] << 24);
}

TEST(BoardLine, TellsWhatItServes) {
  SimulatedLine line(elf_dir + "echo115200.elf", 115200);
  ASSERT_EQ(line.hello().kind, Outcome::Kind::reply);
  ASSERT_EQ(line.host.facts().texts, 2);
  std::uint64_t hash = 0xCBF29CE484222325;
  for (std::uint8_t number = 0; number < 2; ++number) {
    for (const char byte : line.text(number) + '\0') {
      hash = (hash ^ static_cast<unsigned char>(byte)) * 0x100000001B3;
    }
  }
  EXPECT_EQ(line.text(0), "Echo example.echo.Echo");
  EXPECT_EQ(line.text(1).substr(0, 20), "service example.echo");
  EXPECT_EQ(line.host.facts().hash, hash);
}

class RoundTrip : public ::testing::TestWithParam<std::uint32_t> {};

TEST_P(RoundTrip, TakesLittleMoreThanItsBytesDo) {
  const std::uint32_t baud = GetParam();
  SimulatedLine line(elf_dir + "echo" + std::to_string(baud) + ".elf", baud);
  ASSERT_EQ(line.hello().kind, Outcome::Kind::reply);
  std::mt19937 random(5);
  for (int round = 0; round < 30; ++round) {
    const double value = exact(static_cast<std::uint32_t>(random()));
    std::vector<std::uint8_t> body{0, value_member};
    const auto bytes = bytes_of_double(value);
    body.insert(body.end(), bytes.begin(), bytes.end());
    ASSERT_EQ(line.ask(Kind::Set, body).kind, Outcome::Kind::reply);
    line.run(1ms);

    const std::uint64_t before = line.bytes;
    const Time begun = line.board.now();
    const Outcome outcome = line.ask(Kind::Get, {0, value_member});
    const Time took = line.board.now() - begun;
    ASSERT_EQ(outcome.kind, Outcome::Kind::reply);
    EXPECT_EQ(double_in(outcome.body, 1), value);
    EXPECT_EQ(line.bytes - before, 27U);
    const double wire = 27.0 * 10 / baud;
    EXPECT_LE(static_cast<double>(took.count()) * 1e-6, 1.5 * wire + 1e-3) << baud;
  }
  EXPECT_EQ(line.host.repeated(), 0U);
}
INSTANTIATE_TEST_SUITE_P(Rates, RoundTrip, ::testing::Values(9600U, 115200U, 1000000U));

/// Bytes on the line for a get of this value and its answer.
std::uint64_t bytes_of_get(SimulatedLine& line, double value) {
  std::vector<std::uint8_t> body{0, value_member};
  const auto bytes = bytes_of_double(value);
  body.insert(body.end(), bytes.begin(), bytes.end());
  if (line.ask(Kind::Set, body).kind != Outcome::Kind::reply) return 0;
  const std::uint64_t before = line.bytes;
  const Outcome outcome = line.ask(Kind::Get, {0, value_member});
  const double got = double_in(outcome.body, 1);
  // A board's double is a float.
  const auto wanted = static_cast<double>(static_cast<float>(value));
  const bool is_same = std::isnan(value)
                           ? std::isnan(got)
                           : got == wanted && std::signbit(got) == std::signbit(wanted);
  return is_same ? line.bytes - before : 0;
}

TEST(BytesOfAGet, AreAtMost28WhateverTheValue) {
  using Limits = std::numeric_limits<float>;
  SimulatedLine line(elf_dir + "echo115200.elf", 115200);
  ASSERT_EQ(line.hello().kind, Outcome::Kind::reply);
  for (const double value :
       {0.0, -0.0, 1.0, -1.0, 256.0, static_cast<double>(Limits::max()),
        static_cast<double>(Limits::lowest()), static_cast<double>(Limits::min()),
        static_cast<double>(Limits::infinity()), -static_cast<double>(Limits::infinity()),
        static_cast<double>(Limits::quiet_NaN()), static_cast<double>(Limits::epsilon())}) {
    EXPECT_EQ(bytes_of_get(line, value), 27U) << value;
  }
}

TEST(BytesOfAGet, AreTheSameForAllPatternsOfTheEightBytes) {
  // What stuffing changes is where zeros are, and 1 and 255 are what it writes itself.
  for (const std::uint8_t other : std::vector<std::uint8_t>{0x01, 0x08, 0x7F, 0xFF}) {
    for (unsigned zeros = 0; zeros < 256; ++zeros) {
      Frame reply{Kind::Reply, other, {value_member}};
      for (unsigned at = 0; at < 8; ++at) {
        reply.body.push_back((zeros >> at) & 1 ? 0 : other);
      }
      const std::vector<std::uint8_t> bytes = stuff(reply);
      ASSERT_EQ(bytes.size(), 17U);
      EXPECT_EQ(std::count(bytes.begin(), bytes.end(), 0), 2) << "one at each end";
      std::vector<Frame> found;
      FrameFinder().take(bytes, [&](const Frame& frame) { found.push_back(frame); });
      ASSERT_EQ(found, std::vector{reply});
    }
    EXPECT_EQ(stuff({Kind::Get, other, {0, value_member}}).size(), 10U);
  }
}

TEST(HostSide, TellsAnAnswerBeforeWhatCameBehindIt) {
  HostLink host(115200);
  host.begin_session(7, Time(0), 1s);
  (void)host.take_output();
  std::vector<std::uint8_t> facts(14);
  facts[0] = protocolVersion;
  facts[1] = 7;
  host.receive(stuff({Kind::Reply, 0, facts}), Time(1));
  ASSERT_EQ(host.take_outcome()->kind, Outcome::Kind::reply);
  host.request(Kind::Get, {0, value_member}, Time(2), 1s);
  std::vector<std::uint8_t> bytes;
  for (const Frame& frame : {Frame{Kind::Event, 1, {0, 4}}, Frame{Kind::Reply, 1, {value_member}},
                             Frame{Kind::Event, 2, {0, 4}}}) {
    const std::vector<std::uint8_t> more = stuff(frame);
    bytes.insert(bytes.end(), more.begin(), more.end());
  }
  host.receive(bytes, Time(3));
  EXPECT_EQ(host.take_unasked().size(), 1U) << "the one in front of the answer";
  EXPECT_TRUE(host.take_unasked().empty());
  ASSERT_EQ(host.take_outcome()->kind, Outcome::Kind::reply);
  EXPECT_EQ(host.take_unasked().size(), 1U);
}

/// How many calls the tests of bad lines make: more in long runs.
int calls() {
  const char* const given = std::getenv("ROBDEF_BOARD_CALLS");
  return given == nullptr ? 2000 : std::atoi(given);
}

class DamagedBytes : public ::testing::TestWithParam<unsigned> {};

// But for what the CRC lets pass, which the line counts (docs/reference/serial-protocol.md).
TEST_P(DamagedBytes, AreNeverTakenForAValue) {
  SimulatedLine line(elf_dir + "echo115200.elf", 115200, {.damage = 0.01}, GetParam());
  while (line.hello().kind != Outcome::Kind::reply) {
  }
  std::mt19937 random(GetParam());
  std::uint32_t done = 0;
  unsigned wrong = 0;
  for (int call = 0; call < calls(); ++call) {
    const double a = exact(static_cast<std::uint32_t>(random()));
    const double b = exact(static_cast<std::uint32_t>(random())) / 65536;
    const float sum = static_cast<float>(a) + static_cast<float>(b);
    const unsigned forgeries = line.forgeries();
    const Outcome outcome = line.ask(Kind::Call, adding(a, b));
    if (outcome.kind == Outcome::Kind::reply) {
      ++done;
      const bool is_right =
          outcome.body.size() == 9U && double_in(outcome.body, 1) == static_cast<double>(sum);
      ASSERT_TRUE(is_right || line.forgeries() > forgeries) << call;
      if (!is_right) ++wrong;
    } else {
      ASSERT_GT(line.forgeries(), forgeries) << "the line is bad, but not so bad";
      while (line.hello().kind != Outcome::Kind::reply) {
      }
    }
  }
  EXPECT_GT(line.host.repeated(), static_cast<std::uint64_t>(calls()) / 4);
  line.end_noise();
  const unsigned forgeries = line.forgeries();
  EXPECT_LE(forgeries, static_cast<unsigned>(calls()) / 30'000) << "as many as a CRC lets pass";
  const std::uint32_t count = count_of(line);
  if (forgeries != 0) {
    std::cout << forgeries << " forged, " << wrong << " wrong, " << count << " carried out of "
              << done << '\n';
  }
  EXPECT_LE(count > done ? count - done : done - count, forgeries) << "each was done once";
  // Of the events some were refused, since the queue was full; none came twice.
  std::uint32_t last = 0;
  unsigned odd = 0;
  for (const Unasked& event : line.unasked) {
    ASSERT_EQ(event.body.size(), 6U);
    const auto number = static_cast<std::uint32_t>(event.body[2] | event.body[3] << 8 |
                                                   event.body[4] << 16 | event.body[5] << 24);
    if (number <= last) ++odd;
    last = number;
  }
  EXPECT_LE(odd, 2 * forgeries);
}
INSTANTIATE_TEST_SUITE_P(Seeds, DamagedBytes, ::testing::Values(1U, 2U, 3U));

TEST(BadBoardLine, ComesBackWithinATenthOfASecond) {
  const BadLine::Rates rates{
      .damage = 0.05, .drop = 0.02, .twice = 0.02, .burst = 0.05, .half = 0.02};
  for (unsigned seed = 1; seed <= 8; ++seed) {
    SimulatedLine noisy(elf_dir + "echo115200.elf", 115200, rates, seed);
    (void)noisy.hello();
    const Time end = noisy.board.now() + 300ms;
    bool has_ended = false;
    noisy.meanwhile = [&] {
      if (has_ended || noisy.board.now() < end) return;
      has_ended = true;
      noisy.end_noise();
    };
    // Calls until the noise has ended, the last of which it has disturbed.
    while (!has_ended) {
      if (!noisy.host.has_session()) (void)noisy.hello();
      if (noisy.host.has_session()) (void)noisy.ask(Kind::Call, adding(1, 2), 500ms);
    }
    if (!noisy.host.has_session()) (void)noisy.hello();
    EXPECT_EQ(noisy.ask(Kind::Get, {0, value_member}).kind, Outcome::Kind::reply);
    EXPECT_LE(noisy.board.now() - end, 100ms) << seed;
  }
}

TEST(BadBoardLine, LosesNoCallWithoutAnError) {
  const BadLine::Rates rates{
      .damage = 0.01, .drop = 0.005, .twice = 0.005, .burst = 0.01, .half = 0.003};
  for (unsigned seed = 1; seed <= 3; ++seed) {
    SimulatedLine line(elf_dir + "echo115200.elf", 115200, rates, seed);
    while (line.hello().kind != Outcome::Kind::reply) {
    }
    for (int call = 0; call < calls() / 10; ++call) {
      const Outcome outcome = line.ask(Kind::Call, adding(call, 0.5), 300ms);
      if (outcome.kind == Outcome::Kind::reply) {
        ASSERT_EQ(double_in(outcome.body, 1), call + 0.5);
      } else {
        ASSERT_NE(outcome.kind, Outcome::Kind::error);
        while (line.hello().kind != Outcome::Kind::reply) {
        }
      }
    }
  }
}

TEST(BoardResets, AreSeenWhileNothingIsAsked) {
  SimulatedLine line(elf_dir + "echo115200.elf", 115200);
  ASSERT_EQ(line.hello().kind, Outcome::Kind::reply);
  line.board.reset();
  line.run(50ms);
  EXPECT_FALSE(line.host.has_session());
  ASSERT_EQ(line.hello().kind, Outcome::Kind::reply);
  EXPECT_EQ(count_of(line), 0U);
}

TEST(BoardResets, InTheMiddleOfACallFailIt) {
  SimulatedLine line(elf_dir + "echo115200.elf", 115200);
  std::mt19937 random(9);
  for (int round = 0; round < 40; ++round) {
    ASSERT_EQ(line.hello().kind, Outcome::Kind::reply) << round;
    const Time when = line.board.now() + Time(200 + static_cast<int>(random() % 8000));
    bool is_reset = false;
    line.meanwhile = [&] {
      if (is_reset || line.board.now() < when) return;
      is_reset = true;
      line.board.reset();
    };
    Outcome outcome;
    while (!is_reset) outcome = line.ask(Kind::Call, {0, wait_member, 3, 0}, 500ms);
    // One that was answered before the reset has been carried out.
    EXPECT_TRUE(outcome.kind == Outcome::Kind::reset || outcome.kind == Outcome::Kind::reply);
    line.meanwhile = nullptr;
    line.run(20ms);
    EXPECT_FALSE(line.host.has_session());
  }
}

TEST(SlowMembers, AreWaitedFor) {
  SimulatedLine line(elf_dir + "echo115200.elf", 115200);
  ASSERT_EQ(line.hello().kind, Outcome::Kind::reply);
  EXPECT_EQ(line.ask(Kind::Call, {0, wait_member, 0xE8, 3}, 3s).kind, Outcome::Kind::reply);
  EXPECT_EQ(line.ask(Kind::Get, {0, value_member}).kind, Outcome::Kind::reply);
}

}  // namespace
}  // namespace rr::serial::testing
