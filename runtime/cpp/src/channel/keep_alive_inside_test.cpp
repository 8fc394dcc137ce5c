// SPDX-License-Identifier: Apache-2.0
#include <gtest/gtest.h>

#include <string>

#include "runtime/cpp/src/channel/keep_alive.hpp"

namespace rr::channel {
namespace {

using std::chrono_literals::operator""ms;

class KeepAliveTest : public ::testing::Test {
 protected:
  std::string failure(Time now, Time last_sent, bool is_full = false) const {
    const KeepAlive::Look look = keep_alive_.look(now, last_sent, is_full);
    return look.failure == nullptr ? "" : look.failure;
  }

  const Time begin_ = Time() + Milliseconds(1'000'000);
  KeepAlive keep_alive_{
      {.first_message_timeout = 3000ms, .receive_timeout = 10'000ms, .heartbeat_period = 5000ms},
      begin_};
};

TEST_F(KeepAliveTest, TheOtherSideHasToSayWhoItIsInTime) {
  EXPECT_FALSE(keep_alive_.was_heard());
  EXPECT_EQ(failure(begin_ + 2999ms, begin_), "");
  EXPECT_EQ(keep_alive_.look(begin_ + 1ms, begin_, false).next, begin_ + 3000ms);
  EXPECT_EQ(failure(begin_ + 3000ms, begin_), "the other side has not said who it is");
  keep_alive_.set_heard(true);
  EXPECT_TRUE(keep_alive_.was_heard());
  EXPECT_EQ(failure(begin_ + 3000ms, begin_), "");
}

TEST_F(KeepAliveTest, AHeartbeatIsDueWhenNothingWasSentForAPeriod) {
  keep_alive_.set_heard(true);
  const KeepAlive::Look early = keep_alive_.look(begin_ + 4999ms, begin_, false);
  EXPECT_FALSE(early.is_test_due);
  EXPECT_EQ(early.next, begin_ + 5000ms);
  const KeepAlive::Look due = keep_alive_.look(begin_ + 5000ms, begin_, false);
  EXPECT_TRUE(due.is_test_due);
  EXPECT_EQ(due.next, begin_ + 10'000ms);
}

TEST_F(KeepAliveTest, NothingIsSentBeforeTheOtherSideHasSaidWhoItIs) {
  KeepAlive patient({.first_message_timeout = longest_span,
                     .receive_timeout = longest_span,
                     .heartbeat_period = 5000ms},
                    begin_);
  EXPECT_FALSE(patient.look(begin_ + 6000ms, begin_, false).is_test_due);
}

TEST_F(KeepAliveTest, OneThatDoesNotAnswerIsGone) {
  keep_alive_.set_heard(true);
  const Time sent = begin_ + 10'001ms;
  EXPECT_EQ(failure(sent, begin_ + 10'000ms), "");
  EXPECT_EQ(failure(sent, sent), "the other side does not answer any more");
  EXPECT_EQ(failure(sent, sent, true), "") << "it is this side that does not read";
  keep_alive_.note_received(begin_ + 1ms);
  EXPECT_EQ(keep_alive_.last_received(), begin_ + 1ms);
  EXPECT_EQ(failure(sent, sent), "");
}

TEST_F(KeepAliveTest, EndsWhenItWasToBeClosed) {
  keep_alive_.set_heard(true);
  keep_alive_.close_at(begin_ + 100ms);
  EXPECT_EQ(keep_alive_.look(begin_, begin_, false).next, begin_ + 100ms);
  EXPECT_EQ(failure(begin_ + 99ms, begin_), "");
  EXPECT_EQ(failure(begin_ + 100ms, begin_), "the connection was closed");
}

TEST_F(KeepAliveTest, TheFirstLookIsSoon) {
  EXPECT_EQ(keep_alive_.first_look(begin_, 400ms), begin_ + 400ms);
  EXPECT_EQ(keep_alive_.first_look(begin_, 9000ms), begin_ + 5000ms);
}

// Looks at many connections of one age come at the same time.
TEST_F(KeepAliveTest, LooksOfLongPeriodsHaveAGrain) {
  KeepAlive slow(
      {.first_message_timeout = 3000ms, .receive_timeout = 10'000ms, .heartbeat_period = 60'000ms},
      begin_);
  slow.set_heard(true);
  EXPECT_EQ(slow.look(begin_ + 10ms, begin_ + 7ms, false).next, begin_ + 60'050ms);
  EXPECT_EQ(slow.look(begin_ + 10ms, begin_ + 49ms, false).next, begin_ + 60'050ms);
}

}  // namespace
}  // namespace rr::channel
