// SPDX-License-Identifier: Apache-2.0
#include <gtest/gtest.h>

#include "runtime/cpp/src/service/answer_sizes.hpp"

namespace rr::service {
namespace {

constexpr std::size_t mib = 1024 * 1024;

const Member picture{.kind = MemberKind::property, .name = "picture"};
const Member name{.kind = MemberKind::property, .name = "name"};

TEST(AnswerSizes, AreExpectedOfMembersThatHaveGivenLargeOnesOnly) {
  AnswerSizes sizes;
  EXPECT_EQ(sizes.expected(picture), 0U);
  sizes.note(picture, AnswerSizes::large - 1);
  EXPECT_EQ(sizes.expected(picture), 0U);
  sizes.note(picture, 8 * mib);
  EXPECT_EQ(sizes.expected(picture), 8 * mib);
  EXPECT_EQ(sizes.expected(name), 0U);
  sizes.note(name, 100);
  EXPECT_EQ(sizes.expected(name), 0U);
}

TEST(AnswerSizes, GrowAtOnceAndFadeSlowly) {
  AnswerSizes sizes;
  sizes.note(picture, 1 * mib);
  sizes.note(picture, 8 * mib);
  EXPECT_EQ(sizes.expected(picture), 8 * mib);
  sizes.note(picture, 10);
  EXPECT_GT(sizes.expected(picture), 7 * mib);
  EXPECT_LT(sizes.expected(picture), 8 * mib);
  for (int i = 0; i < 99; ++i) sizes.note(picture, 10);
  EXPECT_LT(sizes.expected(picture), 2 * mib);
  EXPECT_GT(sizes.expected(picture), 1 * mib);
  for (int i = 0; i < 200; ++i) sizes.note(picture, 10);
  EXPECT_EQ(sizes.expected(picture), 0U);  // it counts as one of the small ones again
}

}  // namespace
}  // namespace rr::service
