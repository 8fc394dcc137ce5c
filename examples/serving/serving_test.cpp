// SPDX-License-Identifier: Apache-2.0
#include "examples/serving/serving.hpp"

#include <gtest/gtest.h>
#include <pthread.h>
#include <signal.h>

namespace serving {
namespace {

using namespace std::chrono_literals;

TEST(Serving, EndsAfterItsSeconds) {
  const auto begin = std::chrono::steady_clock::now();
  Stay stay(1);
  EXPECT_TRUE(stay.wait(1ms));
  stay.wait_for_end();
  EXPECT_GE(std::chrono::steady_clock::now() - begin, 1s);
  EXPECT_FALSE(stay.wait(1h)) << "does not wait any more";
}

TEST(Serving, EndsWithASignal) {
  Stay stay(0);
  raise(SIGTERM);
  stay.wait_for_end();
  EXPECT_FALSE(stay.wait(1h));
}

TEST(Serving, ReadsSeconds) {
  EXPECT_EQ(read_seconds("60"), 60);
  for (const char* word : {"", "-1", "x", "1x", "99999999999"}) {
    EXPECT_FALSE(read_seconds(word)) << word;
  }
}

}  // namespace
}  // namespace serving
