// SPDX-License-Identifier: Apache-2.0
#include "runtime/cpp/src/platform/threads.hpp"

#include <gtest/gtest.h>

#include <atomic>
#include <chrono>
#include <memory>
#include <string>
#include <thread>
#include <vector>

#include "runtime/cpp/src/platform/thread_object.hpp"

namespace rr::platform {
namespace {

std::atomic<int> living = 0;

/// Large enough that memory which is given back is noticed.
struct Counted {
  Counted() { ++living; }
  ~Counted() {
    EXPECT_EQ(text, std::string(1000, 'x'));
    --living;
  }
  Counted(const Counted&) = delete;
  Counted& operator=(const Counted&) = delete;
  std::string text = std::string(1000, 'x');
};

struct First {};
struct Second {};

TEST(ThreadObjects, IsOneForEachThreadAndEndsWithIt) {
  Counted* const mine = thread_object<Counted, First>();
  ASSERT_NE(mine, nullptr);
  EXPECT_EQ((thread_object<Counted, First>()), mine);
  EXPECT_NE((thread_object<Counted, Second>()), mine);
  EXPECT_EQ(living, 2);
  for (int i = 0; i < 100; ++i) {
    std::thread([&] {
      Counted* const other = thread_object<Counted, First>();
      EXPECT_NE(other, mine);
      EXPECT_EQ((thread_object<Counted, First>()), other);
      EXPECT_EQ(living, 3);
    }).join();
    EXPECT_EQ(living, 2);
  }
}

TEST(ThreadObjects, ManyThreadsAtOnce) {
  const int before = living;
  std::vector<std::thread> threads;
  for (int i = 0; i < 50; ++i) {
    threads.emplace_back([] {
      ASSERT_NE((thread_object<Counted, First>()), nullptr);
      ASSERT_NE((thread_object<Counted, Second>()), nullptr);
    });
  }
  for (std::thread& thread : threads) thread.join();
  EXPECT_EQ(living, before);
}

std::vector<int> ended;
int made = 0;

template <int number>
struct Named {
  Named() { ++made; }
  ~Named() { ended.push_back(number); }
  bool used = false;
};

class ThreadObjectsEnd : public ::testing::Test {
 protected:
  void SetUp() override {
    ended.clear();
    made = 0;
  }
};

TEST_F(ThreadObjectsEnd, TheLastThatWasMadeFirst) {
  std::thread([] {
    thread_object<Named<1>>()->used = true;
    thread_object<Named<2>>()->used = true;
    thread_object<Named<3>>()->used = true;
  }).join();
  EXPECT_EQ(ended, (std::vector{3, 2, 1}));
}

/// Uses another when it ends.
struct User {
  ~User() { thread_object<Named<4>>()->used = true; }
};

// The other may be made for that, even if there was one: either way it ends, too.
TEST_F(ThreadObjectsEnd, AndMayUseOthers) {
  std::thread([] {
    thread_object<Named<4>>()->used = true;
    ASSERT_NE(thread_object<User>(), nullptr);
  }).join();
  EXPECT_GE(made, 1);
  EXPECT_EQ(ended, std::vector(static_cast<std::size_t>(made), 4));
}

TEST_F(ThreadObjectsEnd, AndMayUseWhatHasEnded) {
  std::thread([] {
    ASSERT_NE(thread_object<User>(), nullptr);
    thread_object<Named<4>>()->used = true;
  }).join();
  EXPECT_EQ(ended, (std::vector{4, 4}));
  EXPECT_EQ(made, 2);
}

// With std::thread::detach() some of them get lost on Windows.
TEST(ThreadsApart, AllRun) {
  const auto ran = std::make_shared<std::atomic<int>>(0);
  for (int i = 1; i <= 2000; ++i) {
    run_apart([ran] { ++*ran; });
    const auto limit = std::chrono::steady_clock::now() + std::chrono::seconds(20);
    while (*ran != i && std::chrono::steady_clock::now() < limit) std::this_thread::yield();
    ASSERT_EQ(*ran, i);
  }
}

}  // namespace
}  // namespace rr::platform
