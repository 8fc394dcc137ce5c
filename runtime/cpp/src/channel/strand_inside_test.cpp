// SPDX-License-Identifier: Apache-2.0
#include <gtest/gtest.h>

#include <array>
#include <cstring>
#include <memory>
#include <string>
#include <string_view>
#include <thread>

#include "runtime/cpp/src/channel/strand.hpp"
#include "runtime/cpp/src/channel/strand_turn.hpp"

namespace rr::channel {
namespace {

// Any bytes will do for a message.
Frame message(std::string_view text) {
  return {{reinterpret_cast<const std::byte*>(text.data()), text.size()}, {}, {}};
}
std::string text_of(const Frame& frame) {
  return {reinterpret_cast<const char*>(frame.bytes.data()), frame.bytes.size()};
}

class StrandTest : public ::testing::Test {
 protected:
  using State = Strand::State;

  std::string next() { return text_of(strand_.pop()); }

  Mutex lock_;
  std::shared_ptr<Account> account_;
  Strand strand_{100, account_};
  ScratchLease scratch_;
};

TEST_F(StrandTest, IsEnteredByOneThreadAtATime) {
  EXPECT_EQ(strand_.state(), State::free);
  EXPECT_TRUE(strand_.enter());
  EXPECT_EQ(strand_.state(), State::held);
  EXPECT_FALSE(strand_.enter());
  EXPECT_FALSE(strand_.finish());
  EXPECT_EQ(strand_.state(), State::free);
}

TEST_F(StrandTest, KeepsTheOrderOfMessages) {
  ASSERT_TRUE(strand_.enter());
  strand_.push(message("a"));
  strand_.push(message("b"));
  strand_.push_first(message("before a"));
  EXPECT_EQ(next(), "before a");
  EXPECT_EQ(next(), "a");
  EXPECT_EQ(next(), "b");
  EXPECT_FALSE(strand_.has_queued());
}

// The memory of the caller is used again at once.
TEST_F(StrandTest, CopiesWhatItQueues) {
  std::string text = "first";
  strand_.push(message(text));
  text = "other";
  EXPECT_EQ(next(), "first");
}

TEST_F(StrandTest, IsNotEnteredBeforeWhatIsQueued) {
  strand_.push(message("a"));
  EXPECT_FALSE(strand_.enter());
  strand_.orphan();
  EXPECT_TRUE(strand_.is_orphaned());
  EXPECT_TRUE(strand_.adopt());
  EXPECT_FALSE(strand_.adopt());
  EXPECT_EQ(next(), "a");
}

TEST_F(StrandTest, WaitsWithItsQueueWhenItIsLeft) {
  ASSERT_TRUE(strand_.enter());
  strand_.push(message("a"));
  strand_.leave();
  EXPECT_FALSE(strand_.is_taken());
  EXPECT_TRUE(strand_.has_queued());
  EXPECT_FALSE(strand_.enter());
}

TEST_F(StrandTest, IsFullBeyondItsLimit) {
  strand_.push(message(std::string(60, 'x')));
  strand_.check_limit();
  EXPECT_FALSE(strand_.is_full());
  strand_.push(message(std::string(60, 'x')));
  strand_.check_limit();
  EXPECT_TRUE(strand_.is_full());
  strand_.orphan();
  ASSERT_TRUE(strand_.adopt());
  next();
  next();
  EXPECT_TRUE(strand_.is_full());  // until it has come to the end
  EXPECT_TRUE(strand_.finish());
  EXPECT_FALSE(strand_.is_full());
}

TEST_F(StrandTest, ChargesTheSenderAndGivesBack) {
  const auto pool = std::make_shared<Pool>(1'000'000, 0);
  account_ = std::make_shared<Account>(pool, 400);
  strand_.push(message(std::string(200, 'x')));
  EXPECT_GE(account_->held(), 200U);
  EXPECT_FALSE(strand_.is_full());
  strand_.push(message(std::string(200, 'x')));
  EXPECT_TRUE(strand_.is_full());  // the account is, which pays all the same
  EXPECT_GE(account_->held(), 400U);
  strand_.take_queue().reset();
  EXPECT_EQ(account_->held(), 0U);
}

TEST_F(StrandTest, GoesOnWithoutAThreadThatStepsOut) {
  ASSERT_TRUE(strand_.enter());
  scratch_->waiting.clear();
  scratch_->waiting.push_back(message("rest"));
  StrandTurn turn(strand_, *scratch_, longest_turn);
  EXPECT_TRUE(strand_.step_out(turn));  // somebody has to go on with the rest
  EXPECT_FALSE(turn.is_held());
  EXPECT_EQ(strand_.outside(), 1U);
  EXPECT_EQ(strand_.state(), State::orphaned);
  EXPECT_EQ(text_of(strand_.pop()), "rest");

  const MutexLock lock(lock_);
  EXPECT_TRUE(strand_.step_in(turn, lock_, never));  // faster than the thread that was posted
  EXPECT_TRUE(turn.is_held());
  EXPECT_EQ(strand_.outside(), 0U);
  EXPECT_EQ(strand_.state(), State::held);
}

TEST_F(StrandTest, IsFreeWhenAThreadStepsOutAndNothingWaits) {
  ASSERT_TRUE(strand_.enter());
  scratch_->waiting.clear();
  StrandTurn turn(strand_, *scratch_, longest_turn);
  EXPECT_FALSE(strand_.step_out(turn));
  EXPECT_EQ(strand_.state(), State::free);
  EXPECT_TRUE(strand_.enter());  // by another thread
  const MutexLock lock(lock_);
  EXPECT_FALSE(strand_.step_in(turn, lock_, Time::min()));
  EXPECT_FALSE(turn.is_held());
  EXPECT_EQ(strand_.outside(), 1U);
}

// Who hands on messages orphans the strand for the one that waits, which is woken.
TEST_F(StrandTest, AThreadThatStepsInComesFirst) {
  ASSERT_TRUE(strand_.enter());
  scratch_->waiting.clear();
  StrandTurn turn(strand_, *scratch_, longest_turn);
  strand_.step_out(turn);
  MutexLock lock(lock_);
  ASSERT_TRUE(strand_.enter());
  EXPECT_FALSE(strand_.is_anybody_returning());
  std::thread other([this] {
    for (bool is_returning = false; !is_returning; std::this_thread::yield()) {
      const MutexLock guard(lock_);
      is_returning = strand_.is_anybody_returning();
      if (is_returning) strand_.orphan();
    }
  });
  EXPECT_TRUE(strand_.step_in(turn, lock_, never));
  EXPECT_EQ(strand_.state(), State::held);
  lock.unlock();
  other.join();
}

TEST_F(StrandTest, ASuspendedMessageIsNextAfterResume) {
  ASSERT_TRUE(strand_.enter());
  scratch_->waiting.clear();
  scratch_->waiting.push_back(message("later"));
  StrandTurn turn(strand_, *scratch_, longest_turn);
  strand_.begin_suspending();
  EXPECT_TRUE(strand_.suspend(turn, message("again")));
  EXPECT_EQ(strand_.state(), State::suspended);
  EXPECT_FALSE(strand_.adopt());
  EXPECT_TRUE(strand_.resume());
  EXPECT_FALSE(strand_.resume());
  ASSERT_TRUE(strand_.adopt());
  EXPECT_EQ(next(), "again");
  EXPECT_EQ(next(), "later");
}

TEST_F(StrandTest, AMessageThatIsResumedBeforeItsHandlerReturnsIsHandledAtOnce) {
  ASSERT_TRUE(strand_.enter());
  scratch_->waiting.clear();
  StrandTurn turn(strand_, *scratch_, longest_turn);
  strand_.begin_suspending();
  EXPECT_FALSE(strand_.resume());
  EXPECT_FALSE(strand_.suspend(turn, message("again")));
  EXPECT_EQ(strand_.state(), State::held);
  EXPECT_EQ(next(), "again");
}

TEST_F(StrandTest, TheEndComesOnceAndAfterAllThatIsHandledBeside) {
  strand_.go_beside();
  strand_.owe_end();
  EXPECT_FALSE(strand_.is_end_due());
  EXPECT_FALSE(strand_.take_end());
  strand_.come_from_beside();
  EXPECT_TRUE(strand_.is_end_due());
  EXPECT_TRUE(strand_.take_end());
  EXPECT_FALSE(strand_.take_end());
}

TEST_F(StrandTest, ATurnIsTheInnermostOfItsThread) {
  EXPECT_EQ(StrandTurn::current(strand_), nullptr);
  StrandTurn turn(strand_, *scratch_, longest_turn);
  EXPECT_EQ(StrandTurn::current(strand_), &turn);
  const Strand other(100, account_);
  {
    const ScratchLease scratch;
    StrandTurn inner(other, *scratch, longest_turn);
    EXPECT_EQ(StrandTurn::current(strand_), nullptr);
    EXPECT_EQ(StrandTurn::current(other), &inner);
  }
  EXPECT_EQ(StrandTurn::current(strand_), &turn);
}

}  // namespace
}  // namespace rr::channel
