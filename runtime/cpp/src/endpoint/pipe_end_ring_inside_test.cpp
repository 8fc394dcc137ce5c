// SPDX-License-Identifier: Apache-2.0
// Ends of pipes whose client reads a ring, or has read one: what is sent when it leaves.
#include <gtest/gtest.h>

#include <cstddef>
#include <cstdint>
#include <memory>
#include <optional>
#include <span>
#include <utility>
#include <vector>

#include "rr/error.hpp"
#include "rr/type.hpp"
#include "runtime/cpp/src/endpoint/ring_terms.hpp"
#include "runtime/cpp/src/endpoint/testing/pipe_end_rig.hpp"

namespace rr::endpoint {
namespace {

using rr::testing::numbers_member;
using rr::testing::PipeEndTest;

constexpr double value = 1.5;

// The element `packet` of that number.
MissedPackets::Packet missed_packet() {
  Writer writer;
  writer.reset(MessageVersion::v4);
  type_of<double>.write(writer, "packet", &value);
  const std::vector<std::byte> bytes = writer.copy();
  Allocation memory = allocate(bytes.size());
  std::copy(bytes.begin(), bytes.end(), memory.bytes);
  return {std::move(memory.owner), memory.bytes, bytes.size()};
}

// An end whose client has missed what a test says.
class RingEnd final : public PipeEnd::State {
 public:
  using State::State;
  [[nodiscard]] MissedPackets take_missed() override {
    ++taken;
    return std::exchange(missed, {});
  }

  MissedPackets missed;
  int taken = 0;
};

class PipeEndRingTest : public PipeEndTest {
 protected:
  std::shared_ptr<RingEnd> make_served() {
    auto end = std::make_shared<RingEnd>(core_, side_,
                                         PipeEnd::State::Identity{.path = "arm",
                                                                  .member = &numbers_member,
                                                                  .holding = numbers_member.holding,
                                                                  .index = 4});
    return end;
  }
  // As if its client had read so many packets, and missed others.
  static void leave_with(RingEnd& end, std::uint64_t read, std::size_t missed) {
    end.missed.read = read;
    while (end.missed.packets.size() != missed) end.missed.packets.push_back(missed_packet());
  }
  // Whether a message says no more than that the client is to look at its ring.
  [[nodiscard]] bool is_notice(std::size_t place) const {
    Message message;
    Entry entry;
    EXPECT_TRUE(read_message(side_->fake.sent.at(place), {}, false, message, entry));
    Decoder decoder(message.version, &message.strings);
    return find_ring_notice(decoder, entry) == 4;
  }
  // Messages of packets with numbers from 1 on, as an end without a ring sends them.
  std::vector<std::vector<std::byte>> plain(std::size_t count) {
    const End end = make(numbers_member, 4, false);
    auto before = std::exchange(side_->fake.sent, {});
    while (side_->fake.sent.size() != count) end->send(&value);
    return std::exchange(side_->fake.sent, std::move(before));
  }
};

TEST_F(PipeEndRingTest, EntersWithTheNumberOfTheNextPacket) {
  const auto end = make_served();
  end->send(&value);
  EXPECT_EQ(end->enter_ring([] { return false; }), std::nullopt);
  EXPECT_FALSE(end->is_sent_to_alone());
  EXPECT_EQ(end->enter_ring([] { return true; }), 2U);
  EXPECT_EQ(end->taken, 0);
  leave_with(*end, 3, 0);
  EXPECT_EQ(end->enter_ring([] { return true; }), 5U) << "it has left the ring that it was in";
  end->finish();
  EXPECT_EQ(end->enter_ring([] { return true; }), std::nullopt);
}

TEST_F(PipeEndRingTest, SendsWhatWasMissedWithTheNumbersThatItHasInTheRing) {
  const auto packets = plain(5);
  const auto end = make_served();
  end->send_missed();
  EXPECT_EQ(side_->fake.sent.size(), 0U) << "it is in no ring";
  EXPECT_EQ(end->enter_ring([] { return true; }), 1U);
  leave_with(*end, 2, 2);
  end->send_missed();
  ASSERT_EQ(side_->fake.sent.size(), 3U);
  EXPECT_TRUE(is_notice(0));
  EXPECT_EQ(side_->fake.sent[1], packets[2]);
  EXPECT_EQ(side_->fake.sent[2], packets[3]);
  end->send_missed();
  EXPECT_EQ(end->send(&value), 5U);
  EXPECT_EQ(end->taken, 1);
  EXPECT_FALSE(end->is_sent_to_alone());
}

TEST_F(PipeEndRingTest, APacketForOneClientComesBehindWhatWasMissed) {
  const auto end = make_served();
  EXPECT_EQ(end->enter_ring([] { return true; }), 1U);
  leave_with(*end, 1, 2);
  EXPECT_EQ(end->send(&value), 4U);
  EXPECT_TRUE(end->is_sent_to_alone());
  EXPECT_EQ(side_->fake.sent.size(), 4U);
}

TEST_F(PipeEndRingTest, WhatCannotBeSentIsSentLater) {
  const auto packets = plain(2);
  const auto end = make_served();
  EXPECT_EQ(end->enter_ring([] { return true; }), 1U);
  leave_with(*end, 0, 2);
  side_->fake.refusal = Error(ErrorCode::buffer_limit_violation, "full");
  EXPECT_EQ(failure([&] { end->send_missed(); }), ErrorCode::buffer_limit_violation);
  side_->fake.refusal.reset();
  EXPECT_EQ(end->send(&value), 3U);
  ASSERT_EQ(side_->fake.sent.size(), 4U);
  EXPECT_TRUE(is_notice(0));
  EXPECT_EQ(side_->fake.sent[1], packets[0]);
  EXPECT_EQ(side_->fake.sent[2], packets[1]);
  EXPECT_EQ(end->taken, 1);
}

TEST_F(PipeEndRingTest, WhatIsLostEndsTheSending) {
  const auto end = make_served();
  EXPECT_EQ(end->enter_ring([] { return true; }), 1U);
  end->missed.is_lost = true;
  for (int i = 0; i < 2; ++i) {
    EXPECT_EQ(failure([&] { end->send_missed(); }), ErrorCode::out_of_system_resource);
    EXPECT_EQ(failure([&] { end->send(&value); }), ErrorCode::out_of_system_resource);
  }
  EXPECT_EQ(side_->fake.sent.size(), 0U);
}

TEST_F(PipeEndRingTest, PacketsThatAreAcknowledgedAreInNoRing) {
  const auto end = make_served();
  EXPECT_FALSE(end->asks_for_acknowledgements());
  EXPECT_EQ(end->enter_ring([] { return true; }), 1U);
  leave_with(*end, 0, 1);
  end->ask_for_acknowledgements(true);
  EXPECT_TRUE(end->asks_for_acknowledgements());
  EXPECT_EQ(side_->fake.sent.size(), 2U);
  EXPECT_EQ(end->unacknowledged(), 0U);
}

TEST_F(PipeEndRingTest, NotifiesTheClientOfTheRing) {
  const auto end = make_served();
  end->notify_of_ring();
  ASSERT_EQ(side_->fake.sent.size(), 1U);
  EXPECT_TRUE(is_notice(0));
  end->finish();
  end->notify_of_ring();
  EXPECT_EQ(side_->fake.sent.size(), 1U);
}

TEST_F(PipeEndRingTest, AnUnreliableEndOfARingOrdersByNumbers) {
  const End end = make(numbers_member, 4, true, "arm", true);
  EXPECT_TRUE(end->accept(2, packet(2), 8));
  EXPECT_EQ(value_of(end->take()), 2);
  end->use_numbers();
  EXPECT_TRUE(end->accept(2, packet(2), 8));
  EXPECT_EQ(end->take(), nullptr);
  EXPECT_TRUE(end->accept(1, packet(1), 8));
  EXPECT_EQ(value_of(end->take()), 1);
  EXPECT_EQ(value_of(end->take()), 2);
}

TEST_F(PipeEndRingTest, KnowsWhichPacketsHaveCome) {
  const End end = make();
  EXPECT_TRUE(end->has_come_up_to(0));
  EXPECT_TRUE(end->has_come_up_to(1));
  EXPECT_FALSE(end->has_come_up_to(2));
  EXPECT_TRUE(end->accept(1, packet(1), 8));
  EXPECT_TRUE(end->accept(3, packet(3), 8));
  EXPECT_TRUE(end->has_come_up_to(2));
  EXPECT_FALSE(end->has_come_up_to(3));
  EXPECT_TRUE(end->accept(2, packet(2), 8));
  EXPECT_TRUE(end->has_come_up_to(4));
}

TEST_F(PipeEndRingTest, KnowsWhetherTheProgramWaits) {
  const End end = make();
  EXPECT_FALSE(end->is_listening());
  const Subscription subscription = end->on_received([](const std::shared_ptr<void>&) {});
  EXPECT_TRUE(end->is_listening());
}

}  // namespace
}  // namespace rr::endpoint
