// SPDX-License-Identifier: Apache-2.0
#include <gtest/gtest.h>

#include <atomic>
#include <chrono>
#include <memory>
#include <thread>
#include <vector>

#include "runtime/cpp/src/channel/late_work.hpp"

namespace rr::channel {
namespace {

std::atomic<bool> has_gone{false};

// The last thing that a thread does for a program.
struct Last {
  ~Last() {
    std::this_thread::sleep_for(std::chrono::milliseconds(50));
    has_gone = true;
  }
};

TEST(LateWork, WaitsForTheThreadAndNotOnlyForItsWork) {
  LateWork late;
  has_gone = false;
  late.add([] { thread_local const Last last; });
  late.wait();
  EXPECT_TRUE(has_gone);
}

TEST(LateWork, IsDoneInOrderOverSeveralThreads) {
  std::vector<int> done;
  {
    LateWork late;
    for (int i = 0; i < 100; ++i) {
      late.add([&done, i] { done.push_back(i); });
      if (i % 10 == 0) late.wait();
    }
  }
  ASSERT_EQ(done.size(), 100U);
  for (int i = 0; i < 100; ++i) EXPECT_EQ(done[static_cast<std::size_t>(i)], i);
}

TEST(LateWork, MayOwnItself) {
  auto late = std::make_shared<LateWork>();
  std::atomic<bool> has_ended{false};
  LateWork* const raw = late.get();
  raw->add([owned = std::move(late), &has_ended]() mutable {
    owned.reset();
    has_ended = true;
  });
  while (!has_ended) std::this_thread::yield();
}

TEST(LateWork, KnowsItsThread) {
  LateWork late;
  std::atomic<bool> is_own{false};
  late.add([&] { is_own = late.is_own_thread(); });
  late.wait();
  EXPECT_TRUE(is_own);
  EXPECT_FALSE(late.is_own_thread());
}

}  // namespace
}  // namespace rr::channel
