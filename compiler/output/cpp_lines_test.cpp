// SPDX-License-Identifier: Apache-2.0
#include "compiler/output/cpp_lines.hpp"

#include <gtest/gtest.h>

namespace robdef::cpp {
namespace {

const std::string a_name(36, 'a');
const std::string b_name(36, 'b');

TEST(CppLines, WhatFitsStays) {
  const std::string text = "  int f(int a) { return g(a); }\n\n// " + std::string(97, 'x');
  EXPECT_EQ(broken_lines(text + "\n"), text + "\n");
}

// Templates of users can print anything.
TEST(CppLines, BracketsThatDoNotCloseStay) {
  for (const char* begin :
       {"  f(", "  return a < f(", "  int f(", "  virtual void f(int (", "  x)("}) {
    const std::string text = begin + a_name + ", " + b_name + ", " + a_name + ";";
    EXPECT_EQ(broken(text), text);
  }
}

TEST(CppLines, AFunctionWithOneStatementGetsLinesOfItsOwn) {
  EXPECT_EQ(broken("  int get() { return rr_get<int>(" + a_name + ", " + b_name + "); }"),
            "  int get() {\n    return rr_get<int>(" + a_name + ", " + b_name + ");\n  }");
  EXPECT_EQ(broken("  void f(int " + a_name + ", int " + b_name + ") { g(" + a_name + "); }"),
            "  void f(int " + a_name + ", int " + b_name + ") {\n    g(" + a_name + ");\n  }");
}

TEST(CppLines, ParametersAreAlignedBehindTheirParenthesis) {
  EXPECT_EQ(broken("  virtual int function(int " + a_name + ", ::M<int, int> " + b_name + ") = 0;"),
            "  virtual int function(int " + a_name + ",\n" + std::string(23, ' ') +
                "::M<int, int> " + b_name + ") = 0;");
}

TEST(CppLines, ArgumentsStandBelowWhereThatSavesLines) {
  EXPECT_EQ(broken("  return " + a_name + b_name + "(" + a_name + ", \"text, and (more\");"),
            "  return " + a_name + b_name + "(\n      " + a_name + ", \"text, and (more\");");
}

TEST(CppLines, OfTwoCallsTheInnerOneIsBroken) {
  EXPECT_EQ(broken("    answer(call(" + a_name + ", " + b_name + ", " + a_name + "));"),
            "    answer(call(" + a_name + ", " + b_name + ",\n                " + a_name + "));");
}

TEST(CppLines, AResultThatIsTooLongGetsALineOfItsOwn) {
  const std::string result = "::std::shared_ptr<" + a_name + b_name + ">";
  EXPECT_EQ(broken("  " + result + " get_it(int index);"),
            "  " + result + "\n  get_it(int index);");
}

TEST(CppLines, TheValuesOfAnArrayAreItsItems) {
  EXPECT_EQ(broken("  int array[] = {" + a_name + ", " + b_name + ", \"" + a_name + "\"};"),
            "  int array[] = {" + a_name + ", " + b_name + ",\n" + std::string(17, ' ') + "\"" +
                a_name + "\"};");
}

TEST(CppLines, AVariableIsBrokenBeforeItsValue) {
  EXPECT_EQ(broken("  constexpr auto " + a_name + b_name + " = \"f(x) = {y};\";"),
            "  constexpr auto " + a_name + b_name + " =\n      \"f(x) = {y};\";");
  EXPECT_EQ(broken("using " + a_name + " = ::" + b_name + "::" + a_name + ";"),
            "using " + a_name + " =\n    ::" + b_name + "::" + a_name + ";");
}

TEST(CppLines, AVariableIsBrokenBeforeItsNameWhereTheTypeIsLong) {
  const std::string type = "  ::M<" + a_name + ", " + b_name + ">";
  EXPECT_EQ(broken(type + " " + a_name + "{};"), type + "\n      " + a_name + "{};");
  EXPECT_EQ(broken(type + " " + a_name + ";"), type + "\n      " + a_name + ";");
  EXPECT_EQ(broken(type + " " + a_name + " = 0;"), type + "\n      " + a_name + " = 0;");
  EXPECT_EQ(broken(type + " " + a_name + " = " + b_name + a_name + ";"),
            type + "\n      " + a_name + " =\n          " + b_name + a_name + ";");
  const std::string argument = "::" + a_name + "::" + b_name + "::" + a_name;
  EXPECT_EQ(broken("const T& t<" + argument + "> = ::" + b_name + ";"),
            "const T& t<\n    " + argument + "> =\n    ::" + b_name + ";");
}

TEST(CppLines, TheValuesOfAVariableAreItsItems) {
  EXPECT_EQ(
      broken("const R " + a_name + "{" + b_name + ", \"{x\", " + a_name + "};"),
      "const R " + a_name + "{" + b_name + ", \"{x\",\n" + std::string(45, ' ') + a_name + "};");
  const std::string type = "const " + a_name + b_name;
  EXPECT_EQ(broken(type + " " + a_name + "{" + b_name + "};"),
            type + "\n    " + a_name + "{" + b_name + "};");
}

// As clang-format has it: they are never filled.
TEST(CppLines, ValuesOfWhichOneIsEmptyStandTogetherOrBelowEachOther) {
  EXPECT_EQ(broken("R " + a_name + "{" + b_name + ", {}, " + a_name + "};"),
            "R " + a_name + "{\n    " + b_name + ", {}, " + a_name + "};");
  EXPECT_EQ(broken("R r{" + a_name + ", " + b_name + ", {}, " + a_name + "};"),
            "R r{" + a_name + ",\n    " + b_name + ",\n    {},\n    " + a_name + "};");
  const std::string name = a_name + b_name;
  EXPECT_EQ(broken("R " + name + "{" + a_name + ", {}, " + name + "};"),
            "R " + name + "{\n    " + a_name + ",\n    {},\n    " + name + "};");
}

TEST(CppLines, AConstructorGivesItsParametersToItsBaseOnALineOfItsOwn) {
  EXPECT_EQ(broken("  explicit A(int " + a_name + ", int " + b_name + ") : ::B(" + a_name + ") {}"),
            "  explicit A(int " + a_name + ", int " + b_name + ")\n      : ::B(" + a_name + ") {}");
  EXPECT_EQ(broken("  explicit A(int " + a_name + ", T<int> t = {}, int " + b_name + ") : ::B(" +
                   a_name + ", \"" + a_name + b_name + "\") {}"),
            "  explicit A(int " + a_name + ", T<int> t = {},\n             int " + b_name +
                ")\n      : ::B(" + a_name + ",\n            \"" + a_name + b_name + "\") {}");
}

TEST(CppLines, TheBasesOfAClassStandBelowEachOther) {
  EXPECT_EQ(broken("class A : public " + a_name + ", public M<int, int>, public " + b_name + " {"),
            "class A : public " + a_name + ",\n          public M<int, int>,\n          public " +
                b_name + " {");
  EXPECT_EQ(broken("class " + a_name + b_name + " : public " + a_name + " {"),
            "class " + a_name + b_name + "\n    : public " + a_name + " {");
}

TEST(CppLines, RowsAreInColumns) {
  EXPECT_EQ(columns("  a(1),\n  long_name(2),\n  b(3),\n  c(4),\n  d(5),\n  e(6),\n"),
            "  a(1), long_name(2), b(3), c(4), d(5), e(6),\n");
  EXPECT_EQ(columns("  a,\n  b,\n"), "  a,\n  b,\n");
}

TEST(CppLines, WhatHasNoListStays) {
  for (const char* begin : {"  return ", "#include ", "  x."}) {
    const std::string text = begin + a_name + b_name + a_name + ";";
    EXPECT_EQ(broken(text), text);
  }
}

}  // namespace
}  // namespace robdef::cpp
