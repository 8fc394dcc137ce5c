// SPDX-License-Identifier: Apache-2.0
#include <gtest/gtest.h>

#include <memory>

#include "runtime/cpp/src/endpoint/received_packets.hpp"

namespace rr::endpoint {
namespace {

std::shared_ptr<void> packet(int value) { return std::make_shared<int>(value); }
int value_of(const std::shared_ptr<void>& packet) { return *static_cast<const int*>(packet.get()); }

class ReceivedPacketsTest : public ::testing::Test {
 protected:
  bool add(int value, std::size_t size = 10) { return packets_.add(packet(value), size, 0); }
  bool add_numbered(std::uint32_t number, std::size_t size = 10) {
    return packets_.add_numbered(number, packet(static_cast<int>(number)), size, 0);
  }
  // All that can be taken, as one number.
  int take_all() {
    int taken = 0;
    while (!packets_.empty()) taken = taken * 10 + value_of(packets_.pop());
    return taken;
  }

  const std::shared_ptr<channel::Pool> pool_ = std::make_shared<channel::Pool>(1'000'000, 0);
  const std::shared_ptr<channel::Account> account_ =
      std::make_shared<channel::Account>(pool_, 10'000);
  ReceivedPackets packets_{account_};
};

TEST_F(ReceivedPacketsTest, AreTakenInTheOrderOfTheirNumbers) {
  EXPECT_TRUE(add_numbered(2));
  EXPECT_TRUE(packets_.empty()) << "the first is missing";
  EXPECT_TRUE(add_numbered(1));
  EXPECT_TRUE(add_numbered(4));
  EXPECT_EQ(packets_.size(), 2U);
  EXPECT_EQ(packets_.expected(), 3U);
  EXPECT_EQ(value_of(packets_.front()), 1);
  EXPECT_EQ(take_all(), 12);
  EXPECT_TRUE(add_numbered(3));
  EXPECT_EQ(take_all(), 34);
}

TEST_F(ReceivedPacketsTest, NumbersThatHavePassedOrAreHereAreDropped) {
  EXPECT_TRUE(add_numbered(1));
  EXPECT_TRUE(add_numbered(1));
  EXPECT_TRUE(add_numbered(3));
  EXPECT_TRUE(add_numbered(3));
  EXPECT_TRUE(add_numbered(2));
  EXPECT_EQ(take_all(), 123);
}

TEST_F(ReceivedPacketsTest, WithoutNumbersTheyAreTakenAsTheyCome) {
  EXPECT_TRUE(add(5));
  EXPECT_TRUE(add(3));
  EXPECT_EQ(take_all(), 53);
}

TEST_F(ReceivedPacketsTest, AFullQueueClosesOrDrops) {
  packets_.set_limit(2, WhenFull::close, 1'000'000);
  EXPECT_TRUE(add(1));
  EXPECT_TRUE(add(2));
  EXPECT_FALSE(add(3));
  EXPECT_EQ(packets_.lost_count(), 0U);
  packets_.set_limit(2, WhenFull::drop_newest, 1'000'000);
  EXPECT_TRUE(add(4));
  EXPECT_EQ(packets_.lost_count(), 1U);
  packets_.set_limit(2, WhenFull::drop_oldest, 1'000'000);
  EXPECT_TRUE(add(5));
  EXPECT_EQ(packets_.lost_count(), 2U);
  EXPECT_EQ(take_all(), 25);
}

TEST_F(ReceivedPacketsTest, TheQueueHasALimitOfBytesThatOnePacketMayExceed) {
  packets_.set_limit(100, WhenFull::close, 50);
  EXPECT_TRUE(add(1, 60));
  EXPECT_FALSE(add(2, 1));
  packets_.pop();
  EXPECT_TRUE(add(2, 30));
  EXPECT_TRUE(add(3, 20));
  EXPECT_FALSE(add(4, 1));
}

TEST_F(ReceivedPacketsTest, AreDrawnFromTheAccountWhileTheyAreHere) {
  EXPECT_TRUE(packets_.add(packet(1), 4000, 1000));
  EXPECT_GE(account_->held(), 5000U);
  EXPECT_FALSE(add(2, 5000)) << "the account is full";
  EXPECT_TRUE(add_numbered(2, 3000));
  EXPECT_GE(account_->held(), 8000U);
  EXPECT_FALSE(add_numbered(3, 3000));
  EXPECT_EQ(packets_.drop_held().size(), 1U);
  EXPECT_TRUE(packets_.drop_held().empty());
  EXPECT_LE(account_->held(), 8000U);
  packets_.pop();
  EXPECT_LE(account_->held(), 2U * 1024) << "a little for the next one";
}

TEST_F(ReceivedPacketsTest, AnAccountThatIsFullDropsTheOldestAsAFullQueueDoes) {
  packets_.set_limit(100, WhenFull::drop_oldest, 1'000'000);
  EXPECT_TRUE(add(1, 5000));
  EXPECT_TRUE(add(2, 6000));
  EXPECT_EQ(packets_.lost_count(), 1U);
  EXPECT_EQ(take_all(), 2);
  EXPECT_TRUE(add(3, 20'000)) << "is lost itself";
  EXPECT_EQ(packets_.lost_count(), 2U);
  EXPECT_TRUE(packets_.empty());
}

TEST_F(ReceivedPacketsTest, NotManyMayWaitForEarlierOnes) {
  ReceivedPackets packets(nullptr);
  for (std::uint32_t number = 2; number < 1026; ++number) {
    ASSERT_TRUE(packets.add_numbered(number, packet(0), 1, 0));
  }
  EXPECT_FALSE(packets.add_numbered(1026, packet(0), 1, 0));
  ReceivedPackets large(nullptr);
  EXPECT_TRUE(large.add_numbered(2, packet(0), std::size_t{16} * 1024 * 1024, 0));
  EXPECT_FALSE(large.add_numbered(3, packet(0), 1, 0));
}

TEST_F(ReceivedPacketsTest, NumbersGoOnAfterTheLargest) {
  // 2^32 packets are too many for a test: the first number that is not taken for an old one.
  EXPECT_TRUE(add_numbered(0x80000000U));
  EXPECT_EQ(packets_.drop_held().size(), 1U);
  EXPECT_TRUE(add_numbered(0x80000002U)) << "half of all numbers before is past";
  EXPECT_TRUE(packets_.drop_held().empty());
}

}  // namespace
}  // namespace rr::endpoint
