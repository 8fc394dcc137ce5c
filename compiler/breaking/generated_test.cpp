// SPDX-License-Identifier: Apache-2.0
// What rules about the order of fields say, shown by code that is generated from two versions.
#include <gmock/gmock.h>
#include <gtest/gtest.h>

#include <fstream>
#include <iterator>

#include "compiler/breaking/testing.hpp"

// The header of the program, once for each version.
#define versioned before  // NOLINT(readability-identifier-naming): stands for a namespace
#include "compiler/breaking/testing/user.hpp"
#undef versioned
#define versioned after  // NOLINT(readability-identifier-naming): stands for a namespace
#include "compiler/breaking/testing/user.hpp"
#undef versioned

namespace robdef::breaking {
namespace {

std::string text(const std::string& side) {
  std::ifstream file(std::string(ROBDEF_VERSIONED_DIR) + "/" + side + "/versioned.t.robdef");
  return {std::istreambuf_iterator<char>(file), {}};
}

TEST(BreakingGenerated, TheRulesFindTheOrder) {
  EXPECT_EQ(testing::Compared({text("before")}, {text("after")}).codes(), "R0712 R0779");
}

TEST(BreakingGenerated, FieldsGivenByPositionAreConfused) {
  EXPECT_EQ(before::user::pan_by_position(), 1);
  EXPECT_EQ(after::user::pan_by_position(), 2);
  EXPECT_EQ(before::user::position_by_position(), 1);
  EXPECT_EQ(after::user::position_by_position(), 2);
}

TEST(BreakingGenerated, FramesOfRealTimeNodesAreDropped) {
  EXPECT_EQ(before::user::receive(before::user::frame(3)), 3);
  EXPECT_EQ(after::user::receive(after::user::frame(3)), 3);
  EXPECT_EQ(after::user::receive(before::user::frame(3)), std::nullopt);
  EXPECT_EQ(before::user::receive(after::user::frame(3)), std::nullopt);
}

}  // namespace
}  // namespace robdef::breaking
