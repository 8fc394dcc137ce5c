// SPDX-License-Identifier: Apache-2.0
#include <gtest/gtest.h>

#include "runtime/cpp/src/channel/polling_turn.hpp"

namespace rr::channel {
namespace {

TEST(PollingTurn, CountsWhatIsDoneWithIt) {
  PollingTurn<> turn;
  PollingTurn<>::Count own = turn.begin();
  EXPECT_TRUE(turn.is_of(own));
  EXPECT_FALSE(turn.is_inside(own));
  EXPECT_FALSE(turn.enter(own)) << "nobody sleeps";
  EXPECT_TRUE(turn.is_inside(own));
  EXPECT_EQ(turn.look(), own);
  EXPECT_TRUE(turn.leave(own));
  EXPECT_TRUE(turn.is_of(own));
  EXPECT_FALSE(turn.is_inside(own));
  EXPECT_EQ(turn.begin(), own);
}

TEST(PollingTurn, IsTakenFromTheHandlerThatWasSeen) {
  PollingTurn<> turn;
  PollingTurn<>::Count own = turn.begin();
  static_cast<void>(turn.enter(own));
  const PollingTurn<>::Count seen = turn.look();
  EXPECT_TRUE(turn.take(seen));
  EXPECT_FALSE(turn.take(seen)) << "another thread was faster";
  EXPECT_FALSE(turn.is_of(own));
  EXPECT_FALSE(turn.is_inside(own));
  EXPECT_FALSE(turn.leave(own));
}

TEST(PollingTurn, IsNotTakenFromTheNextHandler) {
  PollingTurn<> turn;
  PollingTurn<>::Count own = turn.begin();
  static_cast<void>(turn.enter(own));
  const PollingTurn<>::Count seen = turn.look();
  ASSERT_TRUE(turn.leave(own));
  static_cast<void>(turn.enter(own));
  EXPECT_FALSE(turn.take(seen));
  EXPECT_TRUE(turn.leave(own));
}

// Takes part in a wait that ends at once, since its time has passed.
TEST(PollingTurn, WakesTheWatchingThreadOnlyWhileItSleepsForLong) {
  PollingTurn<> turn;
  Mutex mutex;
  Condition woken;
  PollingTurn<>::Count own = turn.begin();
  {
    const MutexLock lock(mutex);
    turn.watch(woken, mutex, turn.look(), true, Time(), Time());
    turn.watch(woken, mutex, turn.look(), false, Time(), never);
    turn.wake_watcher(woken);
  }
  EXPECT_FALSE(turn.enter(own)) << "it does not sleep any more";
}

TEST(TurnLooks, FindAHandlerThatTakesLong) {
  TurnLooks looks(6, 2, 3);
  looks.note(7);
  EXPECT_FALSE(looks.is_stuck());
  looks.note(7);
  EXPECT_FALSE(looks.is_stuck());
  looks.note(7);
  EXPECT_TRUE(looks.is_stuck());
  EXPECT_FALSE(looks.is_quiet());
  looks.note(9);
  EXPECT_FALSE(looks.is_stuck()) << "another one";
}

TEST(TurnLooks, FindThatNothingHappens) {
  TurnLooks looks(6, 2, 3);
  looks.note(6);
  looks.note(6);
  EXPECT_FALSE(looks.is_quiet());
  looks.note(6);
  EXPECT_TRUE(looks.is_quiet());
  EXPECT_FALSE(looks.is_stuck());
  looks.note(8);
  EXPECT_FALSE(looks.is_quiet());
}

}  // namespace
}  // namespace rr::channel
