// SPDX-License-Identifier: Apache-2.0
#include <gtest/gtest.h>

#include "runtime/cpp/src/channel/receive_pace.hpp"

namespace rr::channel {
namespace {

using std::chrono_literals::operator""ms;
using std::chrono_literals::operator""us;

constexpr int a_while = 64;

class ReceivePaceTest : public ::testing::Test {
 protected:
  // How many of so many receives found it busy.
  int busy(int receives, Milliseconds pause, std::uint32_t uses = 0) {
    int count = 0;
    for (int i = 0; i < receives; ++i) {
      count += pace_.is_busy(now_, now_ + pause, uses) ? 1 : 0;
      now_ += pause;
    }
    return count;
  }

  Time now_ = Time() + Milliseconds(1'000'000);
  ReceivePace pace_;
};

TEST_F(ReceivePaceTest, IsBusyAfterAWhileOfCloseReceives) {
  EXPECT_EQ(busy(a_while - 1, 4ms), 0);
  EXPECT_EQ(busy(1, 4ms), 1);
  EXPECT_EQ(busy(a_while - 1, 4ms), 0) << "another while";
  EXPECT_EQ(busy(1, 4ms), 1);
}

TEST_F(ReceivePaceTest, APauseBeginsTheWhileAnew) {
  EXPECT_EQ(busy(a_while - 1, 4ms), 0);
  EXPECT_EQ(busy(1, 8ms), 0);
  EXPECT_EQ(busy(a_while - 1, 4ms), 0);
  EXPECT_EQ(busy(1, 4ms), 1);
}

TEST_F(ReceivePaceTest, ACallerThatReadsBeginsTheWhileAnew) {
  EXPECT_EQ(busy(a_while - 1, 4ms), 0);
  EXPECT_EQ(busy(a_while, 4ms, 1), 0) << "the first of them was not alone";
  EXPECT_EQ(busy(1, 4ms, 1), 1);
}

TEST_F(ReceivePaceTest, TwoLongReadsInARowTakeLong) {
  pace_.note_read(101us);
  EXPECT_FALSE(pace_.takes_long());
  pace_.note_read(100us);
  pace_.note_read(101us);
  EXPECT_FALSE(pace_.takes_long()) << "a short one was between";
  pace_.note_read(101us);
  EXPECT_TRUE(pace_.takes_long());
  pace_.note_read(1us);
  EXPECT_FALSE(pace_.takes_long());
}

TEST_F(ReceivePaceTest, MoreThanMayBeReadAtOnceTakesLong) {
  pace_.note_endless();
  EXPECT_TRUE(pace_.takes_long());
}

TEST_F(ReceivePaceTest, ASenderThatWaitsForAcknowledgementsGetsThemAtOnce) {
  pace_.look_for_waiting_sender(now_, now_ + 35ms);
  pace_.look_for_waiting_sender(now_, now_ + 64ms);
  EXPECT_TRUE(pace_.acknowledges_late());
  pace_.look_for_waiting_sender(now_, now_ + 40ms);
  EXPECT_FALSE(pace_.acknowledges_late());
}

}  // namespace
}  // namespace rr::channel
