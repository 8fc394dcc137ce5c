// SPDX-License-Identifier: Apache-2.0
// State over a line that loses, doubles, reorders and holds up packets: the counts are exact, the
// newest wins, and what is too old is as none.
#include "rr/realtime/state_channel.hpp"

#include <gtest/gtest.h>

#include <cstring>
#include <set>
#include <string>
#include <vector>

#include "rr/error.hpp"
#include "rr/realtime/lockstep.hpp"
#include "runtime/cpp/src/realtime/testing/arm_pod.hpp"
#include "runtime/cpp/src/realtime/testing/bad_line.hpp"

namespace rr::realtime {
namespace {

using namespace std::chrono_literals;
using testing::arm_layout;
using testing::ArmPod;
using testing::BadLine;
using testing::LineFaults;
using testing::UdpProxy;

TEST(StateFrame, StandsAsItIsDescribed) {
  StateOutput output(arm_layout(), 0x1122);
  const ArmPod pod{.mode = 9};
  (void)output.make(&pod, 1ns);
  const auto frame = output.make(&pod, 258ns);
  EXPECT_EQ(frame.size(), frame_overhead + arm_layout().packed_size());
  EXPECT_EQ(std::memcmp(frame.data(), "RRSF\1\0\x3C\0", 8), 0);
  EXPECT_EQ(std::memcmp(frame.data() + 16, "\x22\x11\0\0\0\0\0\0", 8), 0) << "epoch";
  EXPECT_EQ(std::memcmp(frame.data() + 24, "\1\0\0\0\0\0\0\0", 8), 0) << "sequence";
  EXPECT_EQ(std::memcmp(frame.data() + 32, "\2\1\0\0\0\0\0\0\x09", 9), 0) << "stamp, payload";
}

TEST(StateFrame, EachChangedByteAndEachShorterFrameIsRefused) {
  StateOutput output(arm_layout(), 1);
  const ArmPod pod{.mode = 9};
  const auto frame = output.make(&pod, 1ns);
  const std::vector<std::byte> good(frame.begin(), frame.end());
  StateReceiver<ArmPod> receiver(arm_layout(), 1s);
  for (std::size_t i = 0; i < good.size(); ++i) {
    std::vector<std::byte> bad = good;
    bad[i] ^= std::byte{0x10};
    EXPECT_FALSE(receiver.take(bad, 1ns)) << i;
    EXPECT_FALSE(receiver.take(std::span(good).first(i), 1ns)) << i;
  }
  const ReceiveCounts& counts = receiver.counts();
  EXPECT_EQ(counts.received, 2 * good.size());
  EXPECT_EQ(counts.damaged + counts.foreign, 2 * good.size());
  EXPECT_EQ(counts.accepted, 0U);
  EXPECT_EQ(receiver.newest(1ns), nullptr);
  EXPECT_TRUE(receiver.take(good, 2ns));
}

TEST(StateFrame, AnotherLayoutIsForeign) {
  const std::vector<SignalEntry> entries{{"mode", SignalType::uint8, 1, 0}};
  StateOutput output(Layout("experimental.arm.ArmPod", entries, 1), 1);
  const std::uint8_t pod = 1;
  StateReceiver<ArmPod> receiver(arm_layout(), 1s);
  EXPECT_FALSE(receiver.take(output.make(&pod, 1ns), 1ns));
  EXPECT_EQ(receiver.counts().foreign, 1U);
  EXPECT_THROW(StateReceiver<std::uint8_t>(arm_layout(), 1s), Error);
}

/// What a receiver has to find, counted in the plainest way.
struct Reference {
  std::set<std::uint64_t> seen;
  std::uint64_t accepted = 0;
  std::uint64_t late = 0;
  std::uint64_t duplicates = 0;

  void take(std::uint64_t sequence) {
    if (seen.contains(sequence)) {
      ++duplicates;
    } else if (seen.empty() || sequence > *seen.rbegin()) {
      ++accepted;
    } else {
      ++late;
    }
    seen.insert(sequence);
  }
  [[nodiscard]] std::uint64_t lost(std::uint64_t first) const {
    if (seen.empty()) return 0;
    std::uint64_t count = 0;
    for (std::uint64_t i = first; i < *seen.rbegin(); ++i) count += seen.contains(i) ? 0 : 1;
    return count;
  }
};

class StateOverABadLine : public ::testing::TestWithParam<LineFaults> {};

TEST_P(StateOverABadLine, TheNewestWinsAndTheCountsAreExact) {
  BadLine line(GetParam(), 20111);
  StateOutput output(arm_layout(), 1);
  StateReceiver<ArmPod> receiver(arm_layout(), 5ms);
  Reference reference;
  std::uint64_t first = 0;
  std::uint64_t newest = 0;
  Nanoseconds last_accepted = -1h;
  int wrong = 0;
  int wrongly_fresh = 0;
  for (std::uint64_t i = 0; i < 20'000; ++i) {
    const Nanoseconds now = 1ms * static_cast<std::int64_t>(i);
    const ArmPod pod{.q = {static_cast<double>(i)}, .sample = i};
    line.push(output.make(&pod, now));
    for (const BadLine::Packet& packet : line.pull(now)) {
      std::uint64_t sequence = 0;
      std::memcpy(&sequence, packet.data() + 24, sizeof sequence);
      if (reference.seen.empty()) first = sequence;
      reference.take(sequence);
      const bool is_newer = receiver.take(packet, now);
      wrong += is_newer == (sequence > newest || reference.seen.size() == 1) ? 0 : 1;
      if (is_newer) {
        newest = sequence;
        last_accepted = now;
      }
      wrong += receiver.last().sample == newest && receiver.sequence() == newest ? 0 : 1;
    }
    wrongly_fresh += receiver.is_fresh(now) == (now - last_accepted <= 5ms) ? 0 : 1;
  }
  const ReceiveCounts& counts = receiver.counts();
  EXPECT_EQ(wrong, 0);
  EXPECT_EQ(wrongly_fresh, 0);
  EXPECT_EQ(counts.accepted, reference.accepted);
  EXPECT_EQ(counts.late, reference.late);
  EXPECT_EQ(counts.duplicates, reference.duplicates);
  EXPECT_EQ(counts.lost, reference.lost(first));
  EXPECT_EQ(counts.damaged + counts.foreign, 0U);
  const double lost = static_cast<double>(counts.lost) / 20'000;
  EXPECT_NEAR(lost, GetParam().loss, 0.01);
}

INSTANTIATE_TEST_SUITE_P(Lines, StateOverABadLine,
                         ::testing::Values(LineFaults{}, LineFaults{.loss = 0.01},
                                           LineFaults{.loss = 0.1}, LineFaults{.loss = 0.3},
                                           LineFaults{.duplicates = 0.2},
                                           LineFaults{.reordered = 0.3},
                                           LineFaults{.stall_begin = 300ms, .stall_length = 50ms},
                                           LineFaults{.loss = 0.1,
                                                      .duplicates = 0.1,
                                                      .reordered = 0.2,
                                                      .longest_delay = 900,
                                                      .stall_begin = 300ms,
                                                      .stall_length = 50ms}));

TEST(StateChannel, AStallIsSeenAfterTheLifespanAndOverWithTheFirstPacket) {
  Lockstep lockstep;
  UdpSocket to_arm("127.0.0.1", 0);
  UdpSocket from_coordinator("127.0.0.1", 0);
  UdpProxy proxy({.stall_begin = 100ms, .stall_length = 50ms}, 1, to_arm.port());
  from_coordinator.connect("127.0.0.1", proxy.port());
  StateSender<ArmPod> sender(arm_layout(), from_coordinator, 1);
  StateReceiver<ArmPod> receiver(arm_layout(), 3ms);
  std::vector<std::uint64_t> without_value;
  std::uint64_t newest = 0;
  lockstep.add(1ms, [&](const Cycle& cycle) {
    EXPECT_TRUE(sender.send({.sample = cycle.number}, cycle.due));
  });
  lockstep.add(1ms, [&](const Cycle& cycle) { proxy.move(cycle.due); });
  lockstep.add(1ms, [&](const Cycle& cycle) {
    receiver.poll(to_arm, cycle.due);
    EXPECT_GE(receiver.last().sample, newest);
    newest = receiver.last().sample;
    if (receiver.newest(cycle.due) == nullptr) without_value.push_back(cycle.number + 1);
  });
  lockstep.run_until(200ms);
  // The last before the stall came at 99 ms and holds for 3 ms; at 150 ms all of it leaves.
  ASSERT_EQ(without_value.size(), 150U - 103);
  EXPECT_EQ(without_value.front(), 103U);
  EXPECT_EQ(without_value.back(), 149U);
  EXPECT_EQ(newest, 199U);
  EXPECT_EQ(receiver.counts().lost, 0U);
  EXPECT_EQ(receiver.counts().accepted, 200U);
}

TEST(StateChannel, ASenderThatBeginsAnewIsFollowedAndItsOldPacketsAreNot) {
  StateReceiver<ArmPod> receiver(arm_layout(), 1s);
  StateOutput old_one(arm_layout(), 1);
  ArmPod pod{.sample = 100};
  for (int i = 0; i < 10; ++i) receiver.take(old_one.make(&pod, 1ns), 1ns);
  StateOutput new_one(arm_layout(), 2);
  pod.sample = 1;
  EXPECT_TRUE(receiver.take(new_one.make(&pod, 2ns), 2ns));
  EXPECT_EQ(receiver.sequence(), 0U);
  pod.sample = 101;
  EXPECT_FALSE(receiver.take(old_one.make(&pod, 3ns), 3ns));
  EXPECT_EQ(receiver.last().sample, 1U);
  EXPECT_EQ(receiver.counts().restarts, 1U);
  EXPECT_EQ(receiver.counts().late, 1U);
}

TEST(StateChannel, AFloodIsTakenInParts) {
  UdpSocket to("127.0.0.1", 0);
  UdpSocket from("127.0.0.1", 0);
  from.connect("127.0.0.1", to.port());
  StateSender<ArmPod> sender(arm_layout(), from, 1);
  for (std::uint64_t i = 0; i < 10; ++i) sender.send({.sample = i}, 0ns);
  StateReceiver<ArmPod> receiver(arm_layout(), 1s);
  EXPECT_TRUE(receiver.poll(to, 1ns, 4));
  EXPECT_EQ(receiver.last().sample, 3U);
  EXPECT_TRUE(receiver.poll(to, 1ns));
  EXPECT_EQ(receiver.last().sample, 9U);
  EXPECT_FALSE(receiver.poll(to, 1ns));
}

TEST(StateChannel, ASocketSaysWhatItCannotBe) {
  EXPECT_THROW(UdpSocket("not an address", 0), Error);
  EXPECT_THROW(UdpSocket("192.0.2.1", 0), Error) << "an address of no machine";
  UdpSocket socket("127.0.0.1", 0);
  EXPECT_NE(socket.port(), 0);
  EXPECT_FALSE(socket.send({})) << "it has no peer";
}

}  // namespace
}  // namespace rr::realtime
