// SPDX-License-Identifier: Apache-2.0
#include <gmock/gmock.h>
#include <gtest/gtest.h>

#include "rr/reader.hpp"

namespace rr {
namespace {

using ::testing::Optional;

// 02, section 6.3.
TEST(StandardStrings, AreFoundByCodeAndByText) {
  EXPECT_THAT(standard_string(0), Optional(std::string_view("")));
  EXPECT_THAT(standard_string(4), Optional(std::string_view("array")));
  EXPECT_THAT(standard_string(228), Optional(std::string_view("return")));
  EXPECT_THAT(standard_string(308), Optional(std::string_view("urgent")));
  EXPECT_THAT(standard_string(512), Optional(std::string_view("username")));
  EXPECT_THAT(standard_string(568),
              Optional(std::string_view("RobotRaconteurServiceIndex.NodeInfo")));
  EXPECT_THAT(standard_string(648), Optional(std::string_view("fiberid")));
  EXPECT_EQ(standard_code("value"), 516U);
  EXPECT_EQ(standard_code("servicename"), 272U);
  EXPECT_EQ(standard_code(""), 0U);
}

TEST(StandardStrings, EndWhereTheTableEnds) {
  for (const std::uint32_t code : {1U, 2U, 3U, 6U, 312U, 508U, 510U, 650U, 652U, 0xFFFFFFFCU}) {
    EXPECT_EQ(standard_string(code), std::nullopt) << code;
  }
  EXPECT_EQ(standard_code("valu"), std::nullopt);
  EXPECT_EQ(standard_code("zzz"), std::nullopt);
}

TEST(StandardStrings, OfTwoEqualTextsTheLowerCodeIsWritten) {
  EXPECT_THAT(standard_string(140), Optional(std::string_view("nodeid")));
  EXPECT_EQ(standard_code("nodeid"), 136U);
  EXPECT_THAT(standard_string(588), Optional(std::string_view("ServiceIndex")));
  EXPECT_EQ(standard_code("ServiceIndex"), 268U);
}

TEST(StandardStrings, EveryCodeLeadsToItsTextAndBack) {
  std::size_t found = 0;
  for (std::uint32_t code = 0; code <= 700; ++code) {
    const auto text = standard_string(code);
    if (!text) continue;
    ++found;
    const auto back = standard_code(*text);
    ASSERT_TRUE(back.has_value());
    EXPECT_EQ(standard_string(*back), text);
    EXPECT_LE(*back, code);
  }
  EXPECT_EQ(found, 113U);
}

TEST(StringTable, FindsItsStringsInWhateverOrderTheyCame) {
  StringTable table;
  EXPECT_TRUE(table.add(7, "seven"));
  EXPECT_TRUE(table.add(1, "one"));
  EXPECT_TRUE(table.add(0xFFFFFFFF, "last"));
  EXPECT_TRUE(table.add(3, "three"));
  EXPECT_THAT(table.find(1), Optional(std::string_view("one")));
  EXPECT_THAT(table.find(3), Optional(std::string_view("three")));
  EXPECT_THAT(table.find(7), Optional(std::string_view("seven")));
  EXPECT_THAT(table.find(0xFFFFFFFF), Optional(std::string_view("last")));
  EXPECT_EQ(table.find(5), std::nullopt);
  EXPECT_EQ(table.find(9), std::nullopt);
}

TEST(StringTable, KeepsTheFirstOfTwoTexts) {
  StringTable table;
  EXPECT_TRUE(table.add(1, "first"));
  EXPECT_TRUE(table.add(1, "second"));
  EXPECT_THAT(table.find(1), Optional(std::string_view("first")));
}

TEST(StringTable, RefusesEvenCodesAndMoreThanItsCapacity) {
  StringTable table;
  EXPECT_FALSE(table.add(2, "two"));
  for (std::uint32_t i = 0; i < StringTable::capacity; ++i) EXPECT_TRUE(table.add(2 * i + 1, "s"));
  EXPECT_FALSE(table.add(2 * StringTable::capacity + 1, "one too many"));
}

TEST(StringTable, KnowsStandardCodesOnlyWhenAgreed) {
  EXPECT_EQ(StringTable().find(228), std::nullopt);
  EXPECT_THAT(StringTable(true).find(228), Optional(std::string_view("return")));
}

TEST(StringTable, IsCopiedAndResetWithItsStrings) {
  StringTable table(true);
  table.add(1, "one");
  const StringTable copy = table;
  table.reset(false);
  EXPECT_EQ(table.find(1), std::nullopt);
  EXPECT_THAT(copy.find(1), Optional(std::string_view("one")));
  EXPECT_THAT(copy.find(4), Optional(std::string_view("array")));
}

}  // namespace
}  // namespace rr
