// SPDX-License-Identifier: Apache-2.0
#include <gmock/gmock.h>
#include <gtest/gtest.h>

#include <algorithm>
#include <deque>
#include <memory>
#include <random>
#include <vector>

#include "runtime/cpp/src/channel/member_timer.hpp"
#include "runtime/cpp/src/channel/timer_heap.hpp"

namespace rr::channel {
namespace {

using ::testing::ElementsAre;

Time at(int time) { return Time(Milliseconds(time)); }

class Noting final : public Timer {
 public:
  Noting(std::vector<int>& log, int name) : log_(log), name_(name) {}

 private:
  void on_timer() override { log_.push_back(name_); }

  std::vector<int>& log_;
  const int name_;
};

class TimerHeaps : public ::testing::Test {
 protected:
  Noting& make(int name) { return timers.emplace_back(log, name); }
  void run_all() {
    while (heap.next_due() != never) heap.take_first().run();
  }

  std::vector<int> log;
  std::deque<Noting> timers;  // which stay where they are
  const std::shared_ptr<int> owner = std::make_shared<int>();
  TimerHeap heap;
};

TEST_F(TimerHeaps, AreEmptyAtFirst) { EXPECT_EQ(heap.next_due(), never); }

TEST_F(TimerHeaps, SayWhetherATimerIsTheFirst) {
  EXPECT_TRUE(heap.schedule(make(1), owner, at(20)));
  EXPECT_FALSE(heap.schedule(make(2), owner, at(30)));
  EXPECT_TRUE(heap.schedule(make(3), owner, at(10)));
  EXPECT_EQ(heap.next_due(), at(10));
  run_all();
  EXPECT_THAT(log, ElementsAre(3, 1, 2));
}

TEST_F(TimerHeaps, TakeTheNewTimeOfATimer) {
  Noting& moved = make(1);
  heap.schedule(moved, owner, at(10));
  heap.schedule(make(2), owner, at(20));
  heap.schedule(moved, owner, at(30));
  EXPECT_EQ(heap.next_due(), at(20));
  run_all();
  EXPECT_THAT(log, ElementsAre(2, 1));
}

TEST_F(TimerHeaps, DoNotKeepWhatIsNeverDue) {
  Noting& timer = make(1);
  heap.schedule(timer, owner, at(10));
  EXPECT_FALSE(heap.schedule(timer, owner, never));
  EXPECT_EQ(heap.next_due(), never);
}

TEST_F(TimerHeaps, ForgetWhatIsCancelled) {
  Noting& first = make(1);
  Noting& last = make(3);
  heap.schedule(first, owner, at(10));
  heap.schedule(make(2), owner, at(20));
  heap.schedule(last, owner, at(30));
  heap.cancel(first);
  heap.cancel(last);
  heap.cancel(last);  // again
  run_all();
  EXPECT_THAT(log, ElementsAre(2));
}

TEST_F(TimerHeaps, RunNothingWhoseOwnerHasGone) {
  heap.schedule(make(1), std::make_shared<int>(), at(10));
  run_all();
  EXPECT_THAT(log, ElementsAre());
}

TEST_F(TimerHeaps, MayBeScheduledAgainAfterItsTime) {
  Noting& timer = make(1);
  heap.schedule(timer, owner, at(10));
  heap.take_first().run();
  EXPECT_TRUE(heap.schedule(timer, owner, at(20)));
  run_all();
  EXPECT_THAT(log, ElementsAre(1, 1));
}

TEST_F(TimerHeaps, KeepTheOrderWhateverIsScheduledMovedAndCancelled) {
  std::mt19937 random(1);
  std::vector<int> due(100, -1);
  for (int name = 0; name < 100; ++name) make(name);
  for (int step = 0; step < 10'000; ++step) {
    const std::size_t name = random() % due.size();
    if (random() % 4 == 0) {
      heap.cancel(timers[name]);
      due[name] = -1;
    } else {
      due[name] = static_cast<int>(random() % 1000);
      heap.schedule(timers[name], owner, at(due[name]));
    }
    const auto earliest = [&] {
      Time first = never;
      for (const int time : due) {
        if (time >= 0) first = std::min(first, at(time));
      }
      return first;
    };
    if (step % 100 == 0) {
      ASSERT_EQ(heap.next_due(), earliest());
    }
  }
  run_all();
  EXPECT_TRUE(std::is_sorted(log.begin(), log.end(), [&](int a, int b) {
    return due[static_cast<std::size_t>(a)] < due[static_cast<std::size_t>(b)];
  }));
  EXPECT_EQ(static_cast<std::ptrdiff_t>(log.size()),
            std::count_if(due.begin(), due.end(), [](int time) { return time >= 0; }));
}

class Owner {
 public:
  void count() { ++calls; }
  int calls = 0;
  MemberTimer<Owner, &Owner::count> timer{*this};
};

TEST(MemberTimer, CallsAFunctionOfItsOwner) {
  Owner owner;
  owner.timer.on_timer();
  owner.timer.on_timer();
  EXPECT_EQ(owner.calls, 2);
}

}  // namespace
}  // namespace rr::channel
