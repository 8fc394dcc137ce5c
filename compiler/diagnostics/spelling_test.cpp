// SPDX-License-Identifier: Apache-2.0
#include "compiler/diagnostics/spelling.hpp"

#include <algorithm>
#include <random>
#include <string>
#include <string_view>
#include <vector>

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

// By the definition of the distance, without rows or limits.
std::size_t plain_distance(std::string_view a, std::string_view b) {
  if (a.empty() || b.empty()) return 2 * (a.size() + b.size());
  const auto lower = [](char c) { return c < 'a' ? c + 32 : c; };
  const std::string_view a_rest = a.substr(1);
  const std::string_view b_rest = b.substr(1);
  const std::size_t change = a[0] == b[0] ? 0 : lower(a[0]) == lower(b[0]) ? 1 : 2;
  std::size_t least = std::min({plain_distance(a_rest, b) + 2, plain_distance(a, b_rest) + 2,
                                plain_distance(a_rest, b_rest) + change});
  if (a.size() > 1 && b.size() > 1 && a[0] == b[1] && a[1] == b[0]) {
    least = std::min(least, plain_distance(a.substr(2), b.substr(2)) + 2);
  }
  return least;
}

TEST(Spelling, IsThatOfTheDefinition) {
  std::mt19937_64 random(7);
  const auto word = [&random](std::size_t longest) {
    std::string text;
    for (std::size_t left = 1 + random() % longest; left > 0; --left) text += "aabBc"[random() % 5];
    return text;
  };
  int found = 0;
  for (int round = 0; round < 400; ++round) {
    const std::string written = word(6);
    std::vector<std::string> words;
    for (int one = 0; one < 4; ++one) words.push_back(word(6));
    std::string_view expected;
    std::size_t least = 2 * std::max<std::size_t>(1, written.size() / 3) + 1;
    for (const std::string& one : words) {
      const std::size_t distance = plain_distance(written, one);
      if (distance >= least || distance >= 2 * std::max(written.size(), one.size())) continue;
      expected = one;
      least = distance;
    }
    const std::string_view near = nearest(written, {words.begin(), words.end()});
    ASSERT_EQ(near, expected) << written;
    found += near.empty() ? 0 : 1;
  }
  EXPECT_GT(found, 100);
}

TEST(Spelling, AVeryLongNameIsNotCompared) {
  EXPECT_EQ(nearest(std::string(100'000, 'x'), {std::string(100'000, 'x')}), "");
}

}  // namespace
}  // namespace robdef
