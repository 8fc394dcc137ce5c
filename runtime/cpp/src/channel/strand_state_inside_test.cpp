// SPDX-License-Identifier: Apache-2.0
#include <gtest/gtest.h>

#include <algorithm>
#include <future>

#include "runtime/cpp/src/channel/strand_state.hpp"
#include "runtime/cpp/src/channel/synchronization.hpp"
#include "runtime/cpp/src/channel/transition.hpp"

namespace rr::channel {
namespace {

using State = StrandState<>;

TEST(StrandState, IsEnteredAndSetFree) {
  State state;
  EXPECT_EQ(state.get(), StrandPhase::free);
  EXPECT_FALSE(state.is_taken());
  EXPECT_TRUE(state.enter());
  EXPECT_EQ(state.get(), StrandPhase::held);
  EXPECT_TRUE(state.is_taken());
  EXPECT_FALSE(state.enter());
  state.set_free();
  EXPECT_EQ(state.get(), StrandPhase::free);
}

TEST(StrandState, AnOrphanIsAdoptedOnce) {
  State state;
  EXPECT_FALSE(state.adopt());
  state.orphan();
  EXPECT_EQ(state.get(), StrandPhase::orphaned);
  EXPECT_TRUE(state.is_taken());
  EXPECT_FALSE(state.enter());
  EXPECT_TRUE(state.adopt());
  EXPECT_EQ(state.get(), StrandPhase::held);
  EXPECT_FALSE(state.adopt());
}

TEST(StrandState, IsGivenUpToOthersWhereTheyHaveToGoOn) {
  State state;
  ASSERT_TRUE(state.enter());
  state.go_outside();
  state.give_up(false);
  EXPECT_EQ(state.get(), StrandPhase::free);
  EXPECT_EQ(state.outside(), 1U);
  ASSERT_TRUE(state.enter());
  state.go_outside();
  state.give_up(true);
  EXPECT_EQ(state.get(), StrandPhase::orphaned);
  EXPECT_EQ(state.outside(), 2U);
  state.come_inside();
  EXPECT_EQ(state.outside(), 1U);
}

TEST(StrandState, AThreadStepsInToAFreeOne) {
  State state;
  Mutex mutex;
  const MutexLock lock(mutex);
  ASSERT_TRUE(state.enter());
  state.go_outside();
  state.give_up(false);
  EXPECT_TRUE(state.step_in(mutex, Time()));
  EXPECT_EQ(state.get(), StrandPhase::held);
  EXPECT_EQ(state.outside(), 0U);
  EXPECT_FALSE(state.is_anybody_returning());
}

TEST(StrandState, AThreadThatStepsInWaitsUntilItIsOrphanedOrTheDeadline) {
  State state;
  Mutex mutex;
  {
    const MutexLock lock(mutex);
    ASSERT_TRUE(state.enter());  // another thread
    state.go_outside();
    EXPECT_FALSE(state.step_in(mutex, Time())) << "it was held";
    EXPECT_EQ(state.outside(), 1U);
  }
  std::future<bool> back = std::async(std::launch::async, [&] {
    const MutexLock lock(mutex);
    return state.step_in(mutex, never);
  });
  for (bool is_returning = false; !is_returning;) {
    const MutexLock lock(mutex);
    is_returning = state.is_anybody_returning();
    if (is_returning) state.give_up(false);  // to the thread that wants it
  }
  EXPECT_TRUE(back.get());
  const MutexLock lock(mutex);
  EXPECT_EQ(state.get(), StrandPhase::held);
  EXPECT_EQ(state.outside(), 0U);
}

TEST(StrandState, IsSuspendedUntilItIsResumed) {
  State state;
  ASSERT_TRUE(state.enter());
  EXPECT_FALSE(state.resume()) << "it is not suspended";
  state.begin_suspending();
  EXPECT_TRUE(state.suspend());
  EXPECT_EQ(state.get(), StrandPhase::suspended);
  EXPECT_TRUE(state.resume());
  EXPECT_EQ(state.get(), StrandPhase::orphaned);
}

TEST(StrandState, IsNotSuspendedWhenItWasResumedBefore) {
  State state;
  ASSERT_TRUE(state.enter());
  state.begin_suspending();
  EXPECT_FALSE(state.resume());
  EXPECT_FALSE(state.suspend());
  EXPECT_EQ(state.get(), StrandPhase::held);
  state.begin_suspending();
  EXPECT_TRUE(state.suspend()) << "once more";
}

TEST(StrandState, AllItsChangesAreInTheTable) {
  const auto rows = State::transitions();
  EXPECT_EQ(rows.size(), 8U);
  EXPECT_TRUE(std::ranges::any_of(rows, [](const auto& row) {
    return row.from == StrandPhase::suspended && row.to == StrandPhase::orphaned;
  }));
  StrandPhase phase = StrandPhase::free;
  change(phase, StrandPhase::held, rows);
  EXPECT_EQ(phase, StrandPhase::held);
  change(phase, StrandPhase::held, rows);
  EXPECT_EQ(phase, StrandPhase::held);
}

TEST(Synchronization, SleepsUntilTheWordChanges) {
  using Sync = Synchronization;
  EXPECT_LE(Sync::coarse_now(), Sync::now());
  Sync::SleepWord word{0};
  Sync::sleep_on(word, 1, never);  // it is not that
  std::future<void> slept = std::async(std::launch::async, [&] {
    while (word == 0) Sync::sleep_on(word, 0, never);
  });
  Sync::yield();
  word = 1;
  Sync::wake(&word);
  slept.get();
  Mutex mutex;
  Condition condition;
  const MutexLock lock(mutex);
  Sync::wait_until(condition, mutex, Time());  // has passed
  wait_until(condition, mutex, Time());
  EXPECT_FALSE(Sync::sleep_on(word, 1, Time())) << "its time has passed";
}

}  // namespace
}  // namespace rr::channel
