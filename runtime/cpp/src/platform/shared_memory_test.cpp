// SPDX-License-Identifier: Apache-2.0
// Memory that processes share, as the header promises it where the system has some.
#include "runtime/cpp/src/platform/shared_memory.hpp"

#include <fcntl.h>
#include <gtest/gtest.h>
#include <sys/mman.h>
#include <unistd.h>

#include <array>
#include <atomic>
#include <chrono>
#include <cstring>
#include <string>
#include <thread>
#include <utility>

#include "runtime/cpp/src/platform/files.hpp"

namespace rr::platform {
namespace {

using std::chrono_literals::operator""ms;
using std::chrono_literals::operator""s;
using Clock = std::chrono::steady_clock;

class SharedMemoryTest : public ::testing::Test {
 protected:
  void SetUp() override {
    if (!has_shared_memory()) GTEST_SKIP() << "this system has none";
    ASSERT_FALSE(make_pair(first_, second_));
  }

  // What the other side of the sockets gets with a byte.
  Descriptor passed(const Descriptor& handle) {
    constexpr std::array<std::byte, 3> said{std::byte{1}, std::byte{2}, std::byte{3}};
    EXPECT_EQ(send_with_handle(first_.get(), said, handle), 3);
    std::array<std::byte, 2> room{};
    Descriptor come;
    EXPECT_EQ(receive_with_handle(second_.get(), room, come), 2);
    EXPECT_EQ(room[1], std::byte{2});
    Descriptor more;
    EXPECT_EQ(receive_with_handle(second_.get(), room, more), 1);
    EXPECT_EQ(room[0], std::byte{3});
    EXPECT_FALSE(more);
    return come;
  }

  static bool may_be_written_to(const SharedMemory& memory) {
    return ::mprotect(memory.bytes(), memory.size(), PROT_READ | PROT_WRITE) == 0;
  }

  Descriptor first_;
  Descriptor second_;
  std::error_code error_;
};

TEST_F(SharedMemoryTest, IsTheSameForWhoeverGetsIt) {
  Descriptor handle;
  const SharedMemory memory = make_shared_memory(8192, handle, error_);
  ASSERT_TRUE(memory) << error_.message();
  EXPECT_EQ(memory.size(), 8192U);
  EXPECT_EQ(memory.bytes()[8191], std::byte{0});

  const Descriptor come = passed(handle);
  const SharedMemory other = map_shared_memory(come, 8192, error_);
  ASSERT_TRUE(other) << error_.message();
  EXPECT_EQ(other.size(), 8192U);
  EXPECT_NE(other.bytes(), memory.bytes());
  memory.bytes()[8191] = std::byte{42};
  EXPECT_EQ(other.bytes()[8191], std::byte{42});
}

TEST_F(SharedMemoryTest, StaysWhenItsMakerHasGone) {
  Descriptor handle;
  SharedMemory memory = make_shared_memory(4096, handle, error_);
  const SharedMemory other = map_shared_memory(handle, 4096, error_);
  ASSERT_TRUE(other);
  memory.bytes()[0] = std::byte{7};
  memory = {};
  handle = {};
  EXPECT_EQ(other.bytes()[0], std::byte{7});
}

TEST_F(SharedMemoryTest, PublishedCanBeReadAlone) {
  Descriptor handle;
  const SharedMemory memory = make_published_memory(8192, handle, error_);
  ASSERT_TRUE(memory) << error_.message();
  const Descriptor come = passed(handle);
  const SharedMemory other = map_published_memory(come, 8192, error_);
  ASSERT_TRUE(other) << error_.message();
  memory.bytes()[8191] = std::byte{42};
  EXPECT_EQ(other.bytes()[8191], std::byte{42});

  // Neither by this mapping, nor by another one, nor by the file, nor by opening that once more.
  EXPECT_FALSE(may_be_written_to(other));
  EXPECT_FALSE(map_shared_memory(come, 8192, error_));
  EXPECT_EQ(error_, std::errc::operation_not_permitted);
  EXPECT_EQ(::pwrite(come.get(), "x", 1, 0), -1);
  const std::string path = "/proc/self/fd/" + std::to_string(come.get());
  const Descriptor again(::open(path.c_str(), O_RDWR | O_CLOEXEC));
  ASSERT_TRUE(again);
  error_ = {};
  EXPECT_FALSE(map_shared_memory(again, 8192, error_));
  EXPECT_EQ(error_, std::errc::operation_not_permitted);
  EXPECT_EQ(::pwrite(again.get(), "x", 1, 0), -1);
  EXPECT_EQ(memory.bytes()[0], std::byte{0});
}

TEST_F(SharedMemoryTest, WhatAnotherReaderCouldWriteToIsNotPublished) {
  Descriptor handle;
  const SharedMemory memory = make_shared_memory(4096, handle, error_);
  ASSERT_TRUE(memory);
  EXPECT_FALSE(map_published_memory(handle, 4096, error_));
  EXPECT_EQ(error_, std::errc::invalid_argument);
  const SharedMemory published = make_published_memory(8192, handle, error_);
  ASSERT_TRUE(published);
  error_ = {};
  EXPECT_FALSE(map_published_memory(handle, 8191, error_));
  EXPECT_EQ(error_, std::errc::invalid_argument);
}

// A reader sleeps on a word that it cannot write to, and may wake others that do.
TEST_F(SharedMemoryTest, ASleeperNeedsNoRightToWrite) {
  Descriptor handle;
  const SharedMemory memory = make_published_memory(4096, handle, error_);
  const SharedMemory other = map_published_memory(handle, 4096, error_);
  ASSERT_TRUE(other);
  auto& word = *new (memory.bytes()) SleepWord{0};
  const auto& same = *reinterpret_cast<const SleepWord*>(other.bytes());
  EXPECT_FALSE(sleep_on_shared(same, 0, 5ms));
  for (const SleepWord* const waking : {&std::as_const(word), &same}) {
    std::atomic<bool> is_woken{false};
    std::thread sleeper([&] { is_woken = sleep_on_shared(same, 0, 20s); });
    while (!is_woken) {
      std::this_thread::sleep_for(1ms);
      wake_shared(waking);
    }
    sleeper.join();
    EXPECT_TRUE(is_woken);
  }
}

TEST_F(SharedMemoryTest, IsRefusedWhenItIsTooLargeOrNone) {
  Descriptor handle;
  const SharedMemory memory = make_shared_memory(8192, handle, error_);
  EXPECT_FALSE(map_shared_memory(handle, 8191, error_));
  EXPECT_EQ(error_, std::errc::invalid_argument);
  error_ = {};
  EXPECT_FALSE(map_shared_memory(first_, 8192, error_));  // a socket
  EXPECT_EQ(error_, std::errc::invalid_argument);
  error_ = {};
  EXPECT_FALSE(map_shared_memory(Descriptor(), 8192, error_));
  EXPECT_EQ(error_, std::errc::invalid_argument);
}

TEST_F(SharedMemoryTest, ASleeperIsWokenWhenTheWordHasChanged) {
  Descriptor handle;
  const SharedMemory memory = make_shared_memory(4096, handle, error_);
  const SharedMemory other = map_shared_memory(handle, 4096, error_);
  ASSERT_TRUE(other);
  auto& word = *new (memory.bytes()) SleepWord{0};
  const auto& same = *reinterpret_cast<const SleepWord*>(other.bytes());
  std::thread sleeper([&] {
    while (same.load() == 0) sleep_on_shared(same, 0, 20s);
    word = 2;
  });
  std::this_thread::sleep_for(10ms);
  word = 1;
  wake_shared(&word);
  sleeper.join();
  EXPECT_EQ(same.load(), 2U);
}

TEST_F(SharedMemoryTest, ASleepEndsInTime) {
  SleepWord word{5};
  EXPECT_FALSE(sleep_on_shared(word, 5, 5ms));
  EXPECT_TRUE(sleep_on_shared(word, 4, 20s));  // it is another by now
}

TEST(Processors, HaveNumbers) {
  EXPECT_LT(current_processor(), 1'000'000U);
  pause_briefly();
}

}  // namespace
}  // namespace rr::platform
