// SPDX-License-Identifier: Apache-2.0
#include "compiler/output/cpp_layout.hpp"

#include <gmock/gmock.h>
#include <gtest/gtest.h>

namespace robdef::cpp {
namespace {

using testing::ElementsAre;

std::string long_name(std::size_t length) { return std::string(length, 'n'); }

TEST(Layout, KeepsWhatFitsOnOneLine) {
  EXPECT_EQ(declaration({.before = "virtual ",
                         .result = "double",
                         .name = "get_speed",
                         .parameters = {},
                         .after = " = 0"},
                        2),
            "virtual double get_speed() = 0;");
}

TEST(Layout, AlignsTheParametersOfADeclaration) {
  EXPECT_EQ(declaration({.result = "void",
                         .name = "f",
                         .parameters = {"int " + long_name(60), "int " + long_name(40)}},
                        2),
            "void f(int " + long_name(60) + ",\n         int " + long_name(40) + ");");
}

TEST(Layout, BreaksBehindTheBracketWhereAligningDoesNotHelp) {
  EXPECT_EQ(
      declaration({.result = "void", .name = long_name(60), .parameters = {long_name(50)}}, 2),
      "void " + long_name(60) + "(\n      " + long_name(50) + ");");
}

TEST(Layout, PutsALongResultOnItsOwnLine) {
  EXPECT_EQ(declaration({.result = long_name(70), .name = long_name(40)}, 2),
            long_name(70) + "\n  " + long_name(40) + "();");
}

TEST(Layout, BreaksACallBehindItsBracketOnlyToSaveALine) {
  const std::string item = long_name(40);
  EXPECT_EQ(list({"call(", {item, item, item}, ");"}, 4),
            "call(" + item + ", " + item + ",\n         " + item + ");");
  const std::string head = std::string(70, 'c') + "(";
  const std::string other = long_name(20);
  EXPECT_EQ(list({head, {other, other, other, other, other}, ");"}, 4),
            head + "\n        " + other + ", " + other + ", " + other + ", " + other +
                ",\n        " + other + ");");
}

TEST(Layout, PutsTablesOfManyShortItemsIntoColumns) {
  EXPECT_THAT(table_rows({"&aaaa,", "&bb,"}, 4), ElementsAre("&aaaa,", "&bb,"));
  const std::vector<std::string> items(6, long_name(20) + ",");
  const std::string row = items[0] + " " + items[0] + " " + items[0];
  EXPECT_THAT(table_rows(items, 4), ElementsAre(row, row));
}

TEST(Layout, KeepsColumnsOfUnequalItemsApart) {
  // More than ten blanks in a column are too many.
  const std::string big = long_name(60) + ",";
  const std::vector<std::string> items{big, "a,", "b,", big, big, "c,"};
  EXPECT_EQ(table_rows(items, 4).size(), 6U);
}

TEST(Layout, ListsSeveralBasesBelowEachOther) {
  EXPECT_EQ(class_head("A", {"public B"}, 0), "class A : public B {");
  EXPECT_EQ(class_head("A", {"public " + long_name(60), "public C" + long_name(40)}, 0),
            "class A : public " + long_name(60) + ",\n          public C" + long_name(40) + " {");
}

TEST(Layout, PutsWhatFollowsLongParametersOnItsOwnLine) {
  const std::string last =
      "const ::std::optional<::std::vector<::rr::VarValue>>& another_parameter_with_a_long_name";
  const Signature signature{
      .result = "void",
      .name = "a_callback_whose_name_is_rather_long",
      .parameters = {"::std::uint32_t client",
                     "const ::rr::VarValue& a_first_parameter_with_a_long_name", last},
      .after = " const"};
  EXPECT_EQ(opening(signature, 2),
            "void a_callback_whose_name_is_rather_long(\n"
            "      ::std::uint32_t client, const ::rr::VarValue& "
            "a_first_parameter_with_a_long_name,\n      " +
                last + ")\n      const {");
}

}  // namespace
}  // namespace robdef::cpp
