// SPDX-License-Identifier: Apache-2.0
#include <gtest/gtest.h>

#include <algorithm>
#include <string>
#include <utility>

#include "runtime/cpp/src/channel/texts.hpp"

namespace rr::channel {
namespace {

using Line = std::pair<std::string_view, std::string_view>;

TEST(Texts, LettersAndDigitsAreThoseOfAscii) {
  EXPECT_TRUE(is_letter('a') && is_letter('z') && is_letter('A') && is_letter('Z'));
  EXPECT_FALSE(is_letter('@') || is_letter('[') || is_letter('`') || is_letter('{'));
  EXPECT_FALSE(is_letter('\xe4') || is_letter('0'));
  EXPECT_TRUE(is_digit('0') && is_digit('9'));
  EXPECT_FALSE(is_digit('/') || is_digit(':') || is_digit('a'));
}

TEST(Texts, BlanksAroundAreTrimmed) {
  EXPECT_EQ(trimmed(" \ta b\r\n"), "a b");
  EXPECT_EQ(trimmed("ab"), "ab");
  EXPECT_EQ(trimmed(" \v\f "), "");
  EXPECT_EQ(trimmed(""), "");
}

TEST(Texts, LowerCaseLeavesOtherBytes) { EXPECT_EQ(in_lower_case("Ab-1\xc3\x84"), "ab-1\xc3\x84"); }

TEST(Texts, ALineIsAKeyAndAValue) {
  EXPECT_EQ(split_line("nodeid:  {1}  "), Line("nodeid", "{1}"));
  EXPECT_EQ(split_line(" a.b-c+d_1 :x:y"), Line("a.b-c+d_1", "x:y"));
  EXPECT_EQ(split_line("key:"), Line("key", ""));
  EXPECT_EQ(split_line("no line"), Line());
  EXPECT_EQ(split_line("two words: x").first, "");
}

TEST(Texts, RandomLettersAreSixteenAndDiffer) {
  const std::string text = random_letters();
  EXPECT_EQ(text.size(), 16U);
  EXPECT_TRUE(std::ranges::all_of(text, [](char c) { return is_letter(c) || is_digit(c); }));
  EXPECT_NE(text, random_letters());
}

}  // namespace
}  // namespace rr::channel
