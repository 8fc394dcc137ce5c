// SPDX-License-Identifier: Apache-2.0
#include <gtest/gtest.h>

#include <atomic>
#include <thread>

#include "runtime/cpp/src/channel/connection_count.hpp"

namespace rr::channel {
namespace {

TEST(ConnectionCount, IsWaitedForUntilAllHaveEnded) {
  ConnectionCount count;
  count.wait_for_none();  // there is none
  count.begin();
  count.begin();
  std::atomic<int> ended{0};
  std::thread last([&] {
    for (int i = 0; i < 2; ++i) {
      ++ended;
      count.end();
    }
  });
  count.wait_for_none();
  EXPECT_EQ(ended, 2);
  last.join();
}

}  // namespace
}  // namespace rr::channel
