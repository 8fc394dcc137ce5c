// SPDX-License-Identifier: Apache-2.0
#include "rr/mutex.hpp"

#include <gtest/gtest.h>

#include <chrono>
#include <stdexcept>
#include <thread>

namespace rr {
namespace {

using std::chrono::steady_clock;

Mutex global_mutex;
static_assert(sizeof(Mutex) == sizeof(std::mutex));
static_assert(sizeof(Condition) == sizeof(std::condition_variable));

bool is_free(Mutex& mutex) {
  bool result = false;
  std::thread([&] {
    if (!mutex.try_lock()) return;
    result = true;
    mutex.unlock();
  }).join();
  return result;
}

TEST(Mutexes, ALockEndsWithItsScopeOrEarlier) {
  EXPECT_TRUE(is_free(global_mutex));
  {
    const MutexLock lock(global_mutex);
    EXPECT_FALSE(is_free(global_mutex));
  }
  EXPECT_TRUE(is_free(global_mutex));
  {
    MutexLock lock(global_mutex);
    lock.unlock();
    EXPECT_TRUE(is_free(global_mutex));
    lock.lock();
    EXPECT_FALSE(is_free(global_mutex));
    lock.unlock();
  }
  EXPECT_TRUE(is_free(global_mutex));
}

TEST(Mutexes, AnExceptionLeavesNoLock) {
  Mutex mutex;
  const auto fail = [&] {
    MutexLock lock(mutex);
    lock.unlock();
    throw std::runtime_error("with the lock released");
  };
  EXPECT_THROW(fail(), std::runtime_error);
  EXPECT_TRUE(is_free(mutex));
  const auto fail_while_given_up = [&] {
    const MutexLock lock(mutex);
    const MutexUnlock unlock(mutex);
    throw std::runtime_error("with the lock given up");
  };
  EXPECT_THROW(fail_while_given_up(), std::runtime_error);
  EXPECT_TRUE(is_free(mutex));
}

TEST(Mutexes, ALockThatIsGivenUpIsTakenAgain) {
  Mutex mutex;
  const MutexLock lock(mutex);
  {
    const MutexUnlock unlock(mutex);
    EXPECT_TRUE(is_free(mutex));
  }
  EXPECT_FALSE(is_free(mutex));
}

struct Flag {
  Mutex mutex;
  Condition changed;
  bool is_set RR_GUARDED_BY(mutex) = false;

  void set() {
    const MutexLock lock(mutex);
    is_set = true;
    changed.notify_all();
  }
};

TEST(Conditions, AWaitReleasesTheMutexAndHoldsItAfterwards) {
  Flag flag;
  std::thread other;
  {
    const MutexLock lock(flag.mutex);
    other = std::thread([&] { flag.set(); });
    while (!flag.is_set) flag.changed.wait(flag.mutex);
    EXPECT_FALSE(is_free(flag.mutex));
  }
  other.join();
  EXPECT_TRUE(is_free(flag.mutex));
}

TEST(Conditions, AWaitWithAPredicateSaysWhatThatSays) {
  Flag flag;
  const auto is_set = [&]() RR_REQUIRES(flag.mutex) { return flag.is_set; };
  {
    const MutexLock lock(flag.mutex);
    const auto soon = steady_clock::now() + std::chrono::milliseconds(20);
    EXPECT_FALSE(flag.changed.wait_until(flag.mutex, soon, is_set));
    EXPECT_GE(steady_clock::now(), soon);
    EXPECT_EQ(flag.changed.wait_until(flag.mutex, steady_clock::now()), std::cv_status::timeout);
    EXPECT_FALSE(is_free(flag.mutex));
  }
  std::thread other([&] { flag.set(); });
  {
    const MutexLock lock(flag.mutex);
    const auto late = steady_clock::now() + std::chrono::minutes(5);
    EXPECT_TRUE(flag.changed.wait_until(flag.mutex, late, is_set));
    EXPECT_FALSE(is_free(flag.mutex));
  }
  other.join();
}

}  // namespace
}  // namespace rr
