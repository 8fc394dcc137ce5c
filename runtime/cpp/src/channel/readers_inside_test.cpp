// SPDX-License-Identifier: Apache-2.0
#include <gtest/gtest.h>

#include "runtime/cpp/src/channel/readers.hpp"

namespace rr::channel {
namespace {

class ReadersTest : public ::testing::Test {
 protected:
  const Time begin_ = Time() + Milliseconds(1'000'000);
  const int one_ = 1;
  const int other_ = 2;
  Readers readers_;
};

TEST_F(ReadersTest, NobodyIsNotSeveral) { EXPECT_FALSE(readers_.are_several(begin_)); }

TEST_F(ReadersTest, OneAloneIsNotSeveralForLong) {
  readers_.note(&one_, begin_);
  for (int i = 0; i < 10; ++i) readers_.note(&one_, begin_ + i * Readers::memory);
  EXPECT_FALSE(readers_.are_several(begin_ + 9 * Readers::memory));
}

TEST_F(ReadersTest, TwoInTurnAreSeveral) {
  readers_.note(&one_, begin_);
  readers_.note(&other_, begin_ + Readers::memory);
  readers_.note(&one_, begin_ + 2 * Readers::memory);
  EXPECT_TRUE(readers_.are_several(begin_ + 2 * Readers::memory));
  EXPECT_TRUE(readers_.are_several(begin_ + 3 * Readers::memory - Milliseconds(1)));
}

TEST_F(ReadersTest, OneThatGoesOnAloneIsForgottenAsSeveral) {
  readers_.note(&one_, begin_);
  readers_.note(&other_, begin_);
  readers_.note(&other_, begin_ + Readers::memory);
  EXPECT_FALSE(readers_.are_several(begin_ + Readers::memory));
}

}  // namespace
}  // namespace rr::channel
