// SPDX-License-Identifier: Apache-2.0
#include "compiler/diagnostics/spelling.hpp"

#include <string>

#include "gtest/gtest.h"

namespace robdef {
namespace {

TEST(Spelling, FindsTheNameWithAMissingLetter) {
  EXPECT_EQ(nearest("Angle", {"Matrix", "Angles", "Angular"}), "Angles");
}

TEST(Spelling, ADifferenceInCaseIsTheSmallest) {
  EXPECT_EQ(nearest("angles", {"angled", "Angles"}), "Angles");
}

TEST(Spelling, SwappedLettersAreOneMistake) {
  EXPECT_EQ(nearest("Vetcor", {"Victor", "Vector"}), "Vector");
}

TEST(Spelling, OfEquallyNearNamesTheFirstIsTaken) {
  EXPECT_EQ(nearest("Box1", {"Box2", "Box3"}), "Box2");
}

TEST(Spelling, NothingIsSaidWhenAllAreFarOff) {
  EXPECT_EQ(nearest("Camera", {"Light", "Room"}), "");
  EXPECT_EQ(nearest("A", {"B"}), "");
  EXPECT_EQ(nearest("Anything", {}), "");
}

TEST(Spelling, AVeryLongNameIsNotCompared) {
  EXPECT_EQ(nearest(std::string(100'000, 'x'), {std::string(100'000, 'x')}), "");
}

}  // namespace
}  // namespace robdef
