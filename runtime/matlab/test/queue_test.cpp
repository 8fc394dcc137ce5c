// SPDX-License-Identifier: Apache-2.0
#include "runtime/matlab/src/queue.hpp"

#include <gmock/gmock.h>
#include <gtest/gtest.h>
#include <time.h>

#include <algorithm>
#include <cstdint>
#include <memory>
#include <thread>
#include <vector>

namespace rr::matlab {
namespace {

using testing::ElementsAre;

/// A queue of numbers, which are noted when their turn comes.
class Numbers {
 public:
  void push(int number, std::uint64_t key = 0) {
    queue.push([this, number] { noted_.push_back(number); }, key);
  }
  std::vector<int> run() {
    noted_.clear();
    while (const Queue::Work work = queue.pop()) work();
    return noted_;
  }
  Queue queue;

 private:
  std::vector<int> noted_;
};

TEST(MatlabQueue, KeepsTheNewestOfAKeyAtThePlaceOfTheFirst) {
  Numbers numbers;
  numbers.push(1, 7);
  numbers.push(2);
  numbers.push(3, 8);
  numbers.push(4, 7);
  numbers.push(5, 8);
  numbers.push(6, 7);
  numbers.push(7);
  EXPECT_EQ(numbers.queue.size(), 4U);
  EXPECT_THAT(numbers.run(), ElementsAre(6, 2, 5, 7));
  EXPECT_EQ(numbers.queue.lost_count(), 0U);
}

TEST(MatlabQueue, PutsAKeyThatWasTakenBehindWhatWaits) {
  Numbers numbers;
  numbers.push(1, 7);
  numbers.push(2, 8);
  numbers.push(3);
  numbers.queue.pop();
  numbers.push(4, 7);
  numbers.push(5, 8);
  EXPECT_THAT(numbers.run(), ElementsAre(5, 3, 4));
}

TEST(MatlabQueue, LosesTheOldestAndItsKeyWithIt) {
  Numbers numbers;
  numbers.push(1, 7);
  numbers.push(2, 8);
  for (std::size_t i = 0; i < Queue::limit - 1; ++i) numbers.push(3);
  EXPECT_EQ(numbers.queue.size(), Queue::limit);
  EXPECT_EQ(numbers.queue.lost_count(), 1U);
  numbers.push(4, 8);  // in place of 2, which waits
  EXPECT_EQ(numbers.queue.lost_count(), 1U);
  numbers.push(5, 7);  // of 1 nothing is left
  EXPECT_EQ(numbers.queue.lost_count(), 2U);
  const auto noted = numbers.run();
  ASSERT_EQ(noted.size(), Queue::limit);
  EXPECT_EQ(noted.front(), 3);
  EXPECT_EQ(noted.back(), 5);
}

TEST(MatlabQueue, KnowsNoKeyAfterItWasCleared) {
  Numbers numbers;
  numbers.push(1, 7);
  numbers.push(2, 8);
  numbers.queue.clear();
  numbers.push(3);
  numbers.push(4, 8);
  numbers.push(5, 8);
  numbers.push(6, 7);
  EXPECT_THAT(numbers.run(), ElementsAre(3, 5, 6));
}

TEST(MatlabQueue, LetsGoOfWhatANewerOneReplaced) {
  Queue queue;
  auto held = std::make_shared<int>(1);
  queue.push([held] { (void)*held; }, 7);
  EXPECT_EQ(held.use_count(), 2);
  queue.push([] {}, 7);
  EXPECT_EQ(held.use_count(), 1);
}

// What a replaced value holds may come back to the queue when it goes.
TEST(MatlabQueue, MayBeUsedByWhatItLetsGo) {
  Queue queue;
  struct Pushes {
    explicit Pushes(Queue& to) : queue(to) {}
    ~Pushes() {
      queue.push([] {});
    }
    Pushes(const Pushes&) = delete;
    Pushes& operator=(const Pushes&) = delete;
    Queue& queue;
  };
  queue.push([pushes = std::make_shared<Pushes>(queue)] { (void)pushes; }, 7);
  queue.push([] {}, 7);
  EXPECT_EQ(queue.size(), 2U);
}

double thread_seconds() {
  timespec now{};
  clock_gettime(CLOCK_THREAD_CPUTIME_ID, &now);
  return static_cast<double>(now.tv_sec) + static_cast<double>(now.tv_nsec) * 1e-9;
}

/// Of `count` values of a wire, in a queue in which `waiting` other things are before it.
double seconds_for(std::size_t waiting, int count) {
  Queue queue;
  for (std::size_t i = 0; i < waiting; ++i) queue.push([] {});
  const Queue::Work work = [] {};
  const double start = thread_seconds();
  for (int i = 0; i < count; ++i) queue.push(work, 7);
  return thread_seconds() - start;
}

// A search of the full queue takes more than half a second for so many values.
TEST(MatlabQueue, TakesAsLongForAValueHoweverManyWait) {
  constexpr int count = 5000;
  const double empty = seconds_for(0, count);
  double full = seconds_for(Queue::limit - 1, count);
  for (int i = 0; i < 2; ++i) full = std::min(full, seconds_for(Queue::limit - 1, count));
  EXPECT_LT(full, 50 * empty + 0.1);
}

TEST(MatlabQueue, IsFilledByManyThreads) {
  Queue queue;
  std::vector<int> last(4, -1);
  {
    std::vector<std::jthread> threads;
    for (std::uint64_t key = 1; key <= 4; ++key) {
      threads.emplace_back([&, key] {
        for (int i = 0; i < 1000; ++i) queue.push([&last, key, i] { last[key - 1] = i; }, key);
      });
    }
    for (int i = 0; i < 100; ++i) {
      if (const Queue::Work work = queue.pop()) work();
    }
  }
  while (const Queue::Work work = queue.pop()) work();
  EXPECT_THAT(last, ElementsAre(999, 999, 999, 999));
}

}  // namespace
}  // namespace rr::matlab
