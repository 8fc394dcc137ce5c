// SPDX-License-Identifier: Apache-2.0
#include <gtest/gtest.h>

#include <array>

#include "runtime/cpp/src/channel/read_lease.hpp"

namespace rr::channel {
namespace {

// The lock is missing: each test is one thread that plays several.
class ReadLeaseTest : public ::testing::Test {
 protected:
  static bool is_answered(const Waiter& waiter) {
    return (waiter.state.load() & Waiter::answered) != 0;
  }

  ReadLease lease_;
  std::array<Waiter, 3> callers_;
};

TEST_F(ReadLeaseTest, BelongsToOneAtATime) {
  EXPECT_FALSE(lease_.is_taken());
  EXPECT_TRUE(lease_.take());
  EXPECT_FALSE(lease_.take());
  EXPECT_TRUE(lease_.is_taken());
  lease_.give_back();
  EXPECT_FALSE(lease_.is_taken());
  EXPECT_TRUE(lease_.take());
}

TEST_F(ReadLeaseTest, RemembersThatSomebodyAskedForMore) {
  EXPECT_FALSE(lease_.is_asked_again());
  lease_.ask_again();
  EXPECT_TRUE(lease_.is_asked_again());
  EXPECT_FALSE(lease_.is_asked_again());
}

TEST_F(ReadLeaseTest, ACallerLeadsUntilItEnds) {
  lease_.lead(callers_[0]);
  EXPECT_TRUE(lease_.is_taken());
  EXPECT_TRUE(callers_[0].is_reader());
  EXPECT_EQ(lease_.uses(), 1U);
  ReadLease::finish_leader(callers_[0]);
  EXPECT_TRUE(callers_[0].is_done());
  lease_.end_lead(callers_[0]);
  EXPECT_FALSE(callers_[0].is_reader());
  EXPECT_TRUE(lease_.is_taken());
  EXPECT_TRUE(lease_.give_back_by_leader());
  EXPECT_FALSE(lease_.is_taken());
  EXPECT_FALSE(lease_.must_search());
}

TEST_F(ReadLeaseTest, TheFollowerThatHasWaitedLongestLeadsNext) {
  ASSERT_TRUE(lease_.take());
  lease_.follow(callers_[0]);
  lease_.follow(callers_[1]);
  EXPECT_EQ(lease_.pass_on(), &callers_[0].state);
  EXPECT_TRUE(callers_[0].is_reader());
  EXPECT_FALSE(callers_[1].is_reader());
  EXPECT_TRUE(lease_.is_taken());
  EXPECT_EQ(lease_.pass_on(), &callers_[1].state);
  EXPECT_EQ(lease_.pass_on(), nullptr);
}

TEST_F(ReadLeaseTest, AFollowerLeavesWhenItsTimeIsOver) {
  for (Waiter& caller : callers_) lease_.follow(caller);
  EXPECT_TRUE(lease_.unfollow(callers_[1]));
  EXPECT_FALSE(lease_.unfollow(callers_[1]));
  EXPECT_EQ(lease_.pass_on(), &callers_[0].state);
  EXPECT_FALSE(lease_.unfollow(callers_[0]));  // it leads
  EXPECT_EQ(lease_.pass_on(), &callers_[2].state);
}

// The first of those that were answered looks, once, and only if nobody reads.
TEST_F(ReadLeaseTest, AnAnsweredFollowerLooksForALeader) {
  lease_.lead(callers_[0]);
  lease_.follow(callers_[1]);
  lease_.follow(callers_[2]);
  lease_.finish_after_receive(callers_[1]);
  EXPECT_TRUE(is_answered(callers_[1]));
  EXPECT_FALSE(callers_[1].is_done());
  lease_.wake_answered();
  EXPECT_TRUE(callers_[1].is_done());

  lease_.end_lead(callers_[0]);
  EXPECT_FALSE(lease_.give_back_by_leader());
  EXPECT_FALSE(lease_.must_search());  // callers_[1] has not run yet
  EXPECT_TRUE(lease_.pass_answered());
  EXPECT_TRUE(lease_.begin_search());
  EXPECT_FALSE(lease_.begin_search());
  EXPECT_EQ(lease_.pass_on(), &callers_[2].state);
}

TEST_F(ReadLeaseTest, NobodyLooksForALeaderWhenTheLastOneIsBack) {
  lease_.lead(callers_[0]);
  lease_.follow(callers_[1]);
  lease_.follow(callers_[2]);
  lease_.finish_after_receive(callers_[1]);
  lease_.wake_answered();
  lease_.end_lead(callers_[0]);
  lease_.give_back_by_leader();
  lease_.lead(callers_[0]);
  EXPECT_FALSE(lease_.pass_answered());
  EXPECT_FALSE(lease_.begin_search());
}

// A leader that has woken nobody looks itself: no other thread would.
TEST_F(ReadLeaseTest, ALeaderThatGivesUpLooksForAnother) {
  lease_.lead(callers_[0]);
  lease_.follow(callers_[1]);
  lease_.end_lead(callers_[0]);
  EXPECT_FALSE(lease_.give_back_by_leader());
  EXPECT_TRUE(lease_.must_search());
  EXPECT_TRUE(lease_.begin_search());
  EXPECT_EQ(lease_.pass_on(), &callers_[1].state);
}

TEST_F(ReadLeaseTest, AnAnsweredCallerThatDoesNotSleepIsDoneAtOnce) {
  ASSERT_TRUE(lease_.take());
  lease_.finish_after_receive(callers_[0]);  // it has not begun to follow
  EXPECT_TRUE(callers_[0].is_done());
  EXPECT_FALSE(is_answered(callers_[0]));
  lease_.wake_answered();
  EXPECT_EQ(lease_.expected_callers(), 0U);
}

TEST_F(ReadLeaseTest, FinishSaysWhetherTheWaiterSleeps) {
  lease_.follow(callers_[0]);
  EXPECT_TRUE(lease_.finish(callers_[0]));
  EXPECT_TRUE(callers_[0].is_done());
  EXPECT_FALSE(lease_.finish(callers_[1]));
  EXPECT_TRUE(callers_[1].is_done());
}

TEST_F(ReadLeaseTest, ExpectsThoseThatItHasWokenAndTheirLeader) {
  EXPECT_FALSE(lease_.arrive());
  lease_.lead(callers_[0]);
  lease_.follow(callers_[1]);
  lease_.follow(callers_[2]);
  lease_.finish_after_receive(callers_[1]);
  lease_.finish_after_receive(callers_[2]);
  lease_.wake_answered();
  lease_.end_lead(callers_[0]);
  EXPECT_EQ(lease_.expected_callers(), 3U);
  EXPECT_TRUE(lease_.arrive());
  EXPECT_TRUE(lease_.arrive());
  EXPECT_TRUE(lease_.arrive());
  EXPECT_FALSE(lease_.arrive());
}

TEST_F(ReadLeaseTest, APinnedThreadCountsAsAUse) {
  EXPECT_EQ(lease_.uses(), 0U);
  lease_.count_use();
  lease_.count_use();
  EXPECT_EQ(lease_.uses(), 2U);
}

}  // namespace
}  // namespace rr::channel
