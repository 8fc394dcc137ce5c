// SPDX-License-Identifier: Apache-2.0
#include "compiler/model/evaluate.hpp"

#include <cmath>
#include <cstdint>
#include <limits>
#include <string>
#include <string_view>
#include <variant>
#include <vector>

#include "compiler/model/compiled.hpp"
#include "gmock/gmock.h"
#include "gtest/gtest.h"

namespace robdef::model {
namespace {

using ::testing::ElementsAre;
using ::testing::IsEmpty;

Number number(Primitive type, std::string_view literal) {
  const auto value = number_of(type, literal);
  EXPECT_TRUE(value.has_value()) << literal;
  return value.value_or(Number{});
}

TEST(Evaluate, IntegersAreExactToTheirLimits) {
  EXPECT_EQ(number(Primitive::int8, "-128"), Number{std::int64_t{-128}});
  EXPECT_EQ(number(Primitive::int32, "-0x80000000"), Number{std::int64_t{-2147483648}});
  EXPECT_EQ(number(Primitive::int64, "-9223372036854775808"),
            Number{std::numeric_limits<std::int64_t>::min()});
  EXPECT_EQ(number(Primitive::uint64, "0xFFFFFFFFFFFFFFFF"),
            Number{std::numeric_limits<std::uint64_t>::max()});
  EXPECT_EQ(number(Primitive::int16, "+10"), Number{std::int64_t{10}});
}

TEST(Evaluate, WhatDoesNotFitHasNoValue) {
  EXPECT_FALSE(number_of(Primitive::int16, "32768"));
  EXPECT_FALSE(number_of(Primitive::int8, "-129"));
  EXPECT_FALSE(number_of(Primitive::uint8, "256"));
  EXPECT_FALSE(number_of(Primitive::int32, "0xFFFFFFFF"));
  EXPECT_FALSE(number_of(Primitive::uint64, "18446744073709551616"));
  EXPECT_FALSE(number_of(Primitive::double_, "1e400"));
  EXPECT_FALSE(number_of(Primitive::single, "1e39"));
  EXPECT_FALSE(number_of(Primitive::bool_, "1"));
}

TEST(Evaluate, NegativeUnsignedConstantsWrapInTheirWidth) {
  EXPECT_EQ(number(Primitive::uint8, "-1"), Number{std::uint64_t{255}});
  EXPECT_EQ(number(Primitive::uint32, "-4294967295"), Number{std::uint64_t{1}});
  EXPECT_EQ(number(Primitive::uint64, "-1"), Number{std::numeric_limits<std::uint64_t>::max()});
}

TEST(Evaluate, FloatingPointNumbersAreTheNearestOfTheirType) {
  EXPECT_EQ(number(Primitive::double_, "-1.5e-3"), Number{-1.5e-3});
  EXPECT_EQ(number(Primitive::double_, ".5"), Number{0.5});
  EXPECT_EQ(number(Primitive::double_, "5."), Number{5.0});
  EXPECT_EQ(number(Primitive::double_, "+1E+2"), Number{100.0});
  EXPECT_EQ(number(Primitive::single, "0.1"), Number{static_cast<double>(0.1f)});
}

TEST(Evaluate, FloatingPointNumbersMayBeTooSmallButNotTooLarge) {
  EXPECT_EQ(number(Primitive::double_, "1e-400"), Number{0.0});
  EXPECT_EQ(number(Primitive::single, "1e-60"), Number{0.0});
  EXPECT_EQ(number(Primitive::double_, "0." + std::string(400, '0') + "1"), Number{0.0});
  EXPECT_TRUE(std::signbit(std::get<double>(number(Primitive::double_, "-1e-400"))));
  EXPECT_EQ(number(Primitive::double_, "5e-324"),
            Number{std::numeric_limits<double>::denorm_min()});
  EXPECT_FALSE(number_of(Primitive::double_, "1" + std::string(400, '0')));
}

TEST(Evaluate, ConstantsHaveTheirValues) {
  const Compiled result = compiled_lines(
      "constant int32 A -0x1F\nconstant double[] B {1, 2.5}\nconstant string C \"a\\n\\u00e9\"\n"
      "constant struct D {x: A, y: C}\nconstant uint8[] E {}\n");
  EXPECT_THAT(result.codes(), IsEmpty());
  const std::vector<Constant>& constants = result.definition(0).constants;
  EXPECT_EQ(std::get<Number>(constants[0].value), Number{std::int64_t{-31}});
  EXPECT_THAT(std::get<std::vector<Number>>(constants[1].value),
              ElementsAre(Number{1.0}, Number{2.5}));
  EXPECT_EQ(std::get<std::string>(constants[2].value), "a\n\xC3\xA9");
  EXPECT_TRUE(constants[3].is_struct);
  const auto& fields = std::get<std::vector<StructValueField>>(constants[3].value);
  ASSERT_EQ(fields.size(), 2u);
  EXPECT_EQ(fields[0].field, "x");
  EXPECT_EQ(fields[0].constant, &constants[0]);
  EXPECT_EQ(fields[1].constant, &constants[2]);
  EXPECT_THAT(std::get<std::vector<Number>>(constants[4].value), IsEmpty());
}

TEST(Evaluate, AStructConstantSeesOnlyItsOwnScope) {
  const Compiled result = compiled_lines(
      "constant int32 B 1\nobject O\nconstant int32 C 1\nconstant struct A {x: B, y: C}\nend\n");
  EXPECT_THAT(result.codes(), ElementsAre("R0305"));
  EXPECT_EQ(result.marked(0), "B");
  EXPECT_EQ(result.help(0), "declare it in the block");
}

TEST(Evaluate, AnUnknownConstantGetsTheNearestName) {
  const Compiled result = compiled_lines("constant int32 FIRST 1\nconstant struct A {x: FRIST}\n");
  EXPECT_THAT(result.codes(), ElementsAre("R0305"));
  EXPECT_EQ(result.help(0), "`FIRST` is close");
}

TEST(Evaluate, EachCycleOfStructConstantsIsReportedOnce) {
  const Compiled result = compiled_lines(
      "constant struct A {x: B}\nconstant struct B {y: C}\nconstant struct C {z: B}\n"
      "constant struct D {d: D}\n");
  EXPECT_THAT(result.codes(), ElementsAre("R0305", "R0305"));
  EXPECT_EQ(result.marked(0), "C");
  EXPECT_EQ(result.marked(1), "D");
}

TEST(Evaluate, EnumValuesFollowTheOneBeforeInItsSpelling) {
  const Compiled result = compiled_lines("enum E\na = -2, b,\nc = 0x10,\nd,\ne = 5\nend\n");
  EXPECT_THAT(result.codes(), IsEmpty());
  const auto& values = result.definition(0).enums[0].values;
  ASSERT_EQ(values.size(), 5u);
  EXPECT_EQ(values[1].value, -1);
  EXPECT_FALSE(values[1].is_hexadecimal);
  EXPECT_EQ(values[3].value, 17);
  EXPECT_TRUE(values[3].is_hexadecimal);
  EXPECT_EQ(values[4].value, 5);
  EXPECT_FALSE(values[4].is_hexadecimal);
}

TEST(Evaluate, AfterTheLargestEnumValueComesTheSmallest) {
  const Compiled result = compiled_lines("enum E\na = 2147483647,\nb\nend\n");
  EXPECT_EQ(result.definition(0).enums[0].values[1].value,
            std::numeric_limits<std::int32_t>::min());
}

}  // namespace
}  // namespace robdef::model
