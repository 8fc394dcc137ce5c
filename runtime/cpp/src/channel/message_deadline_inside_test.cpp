// SPDX-License-Identifier: Apache-2.0
#include <gtest/gtest.h>

#include "runtime/cpp/src/channel/message_deadline.hpp"

namespace rr::channel {
namespace {

using std::chrono_literals::operator""ms;

TEST(MessageDeadline, IsNotSetUntilAMessageBegins) {
  MessageDeadline deadline;
  EXPECT_FALSE(deadline.is_set());
  EXPECT_EQ(deadline.due(), never);
  deadline.restart();
  EXPECT_FALSE(deadline.is_set());
}

TEST(MessageDeadline, GivesALargeMessageTheTimeOfASlowLine) {
  MessageDeadline deadline;
  const Time before = coarse_now();
  deadline.begin(std::size_t{640} * 1024, 500ms);  // 64 KiB a second
  EXPECT_TRUE(deadline.is_set());
  EXPECT_GE(deadline.due(), before + 10'500ms);
  EXPECT_LE(deadline.due(), coarse_now() + 10'500ms);
  deadline.end();
  EXPECT_FALSE(deadline.is_set());
}

TEST(MessageDeadline, GivesTheSameTimeOnceMore) {
  MessageDeadline deadline;
  deadline.begin(0, 60'000ms);
  const Time first = deadline.due();
  const Time before = Clock::now();
  deadline.restart();
  EXPECT_GE(deadline.due(), first);
  EXPECT_GE(deadline.due(), before + 60'000ms);
}

TEST(MessageDeadline, AnAllowanceForEverNeverEnds) {
  MessageDeadline deadline;
  deadline.begin(100, Milliseconds::max());
  EXPECT_EQ(deadline.due(), never);
}

TEST(Time, SpansAsLongAsForEverAreNever) {
  const Time now = Clock::now();
  EXPECT_EQ(saturated(Milliseconds::max()), longest_span);
  EXPECT_EQ(saturated(Milliseconds::min()), -longest_span);
  EXPECT_EQ(saturated(5ms), 5ms);
  EXPECT_EQ(after(now, 5ms), now + 5ms);
  EXPECT_EQ(after(now, Milliseconds::max()), never);
  EXPECT_EQ(after(now, longest_span - 1ms), now + (longest_span - 1ms));
  EXPECT_EQ(after(now, Milliseconds::min()), now - longest_span);
}

}  // namespace
}  // namespace rr::channel
