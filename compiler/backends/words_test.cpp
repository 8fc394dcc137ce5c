// SPDX-License-Identifier: Apache-2.0
#include "compiler/backends/words.hpp"

#include <gmock/gmock.h>
#include <gtest/gtest.h>

namespace robdef {
namespace {

using testing::ElementsAre;

TEST(Words, AreCutAtUnderscoresAndCapitals) {
  EXPECT_THAT(words_of("move_to"), ElementsAre("move", "to"));
  EXPECT_THAT(words_of("moveTo"), ElementsAre("move", "To"));
  EXPECT_THAT(words_of("RGBLight2"), ElementsAre("RGB", "Light2"));
  EXPECT_THAT(words_of("a__b"), ElementsAre("a", "b"));
  EXPECT_THAT(words_of("GetX2Y"), ElementsAre("Get", "X2", "Y"));
}

TEST(Words, TakeTheCasesOfLanguages) {
  EXPECT_EQ(pascal_case("move_to"), "MoveTo");
  EXPECT_EQ(camel_case("Move_to"), "moveTo");
  EXPECT_EQ(snake_case("RGBLight"), "rgb_light");
  EXPECT_EQ(pascal_case("RGBLight"), "RGBLight");
}

TEST(Words, JoinAndReplace) {
  EXPECT_THAT(segments_of("a.b.c"), ElementsAre("a", "b", "c"));
  EXPECT_THAT(segments_of("a"), ElementsAre("a"));
  EXPECT_EQ(replace_all("a.b.c", ".", "::"), "a::b::c");
  EXPECT_EQ(join({"a", "b"}, ", "), "a, b");
  EXPECT_EQ(join({}, ", "), "");
}

TEST(Words, CutTextsIntoLinesWithTheirEnds) {
  EXPECT_THAT(lines_of("a\n\nb"), ElementsAre("a\n", "\n", "b"));
  EXPECT_THAT(lines_of("a\n"), ElementsAre("a\n"));
  EXPECT_TRUE(lines_of("").empty());
}

TEST(Words, AParameterThatBeginsAsNoNameGetsABeginning) {
  EXPECT_EQ(as_variable("speed"), "speed");
  EXPECT_EQ(as_variable("_x"), "_x");
  EXPECT_EQ(as_variable("1st"), "p_1st");
  EXPECT_EQ(as_variable(camel_case("_")), "p_");
}

}  // namespace
}  // namespace robdef
