// SPDX-License-Identifier: Apache-2.0
#include "compiler/backends/cpp/constants.hpp"

#include <gtest/gtest.h>

#include "compiler/backends/cpp/literal_text.hpp"
#include "compiler/backends/literals.hpp"
#include "gmock/gmock.h"

namespace robdef::cpp {
namespace {

using model::Number;
using model::Primitive;
using testing::ElementsAre;

TEST(Literals, KeepNumbersAsTheyWereWritten) {
  EXPECT_EQ(number_literal(Number(std::int64_t{31}), "0x1F", Primitive::int32), "0x1F");
  EXPECT_EQ(number_literal(Number(std::int64_t{5}), "+5", Primitive::int16), "5");
  EXPECT_EQ(number_literal(Number(1.5), "1.5", Primitive::double_), "1.5");
  EXPECT_EQ(number_literal(Number(100.0), "1e2", Primitive::single), "1e2F");
}

TEST(Literals, MakeWholeNumbersFloating) {
  EXPECT_EQ(number_literal(Number(3.0), "3", Primitive::double_), "3.0");
  EXPECT_EQ(number_literal(Number(-3.0), "-3", Primitive::single), "-3.0F");
}

TEST(Literals, AvoidWhatCompilersWarnOf) {
  EXPECT_EQ(number_literal(Number(0.0), "1e-400", Primitive::double_), "0.0");
  EXPECT_EQ(number_literal(Number(1e-60), "1e-60", Primitive::single), "0.0F");
  EXPECT_EQ(number_literal(Number(std::uint64_t{18446744073709551615U}), "18446744073709551615",
                           Primitive::uint64),
            "18446744073709551615U");
  EXPECT_EQ(number_literal(Number(std::numeric_limits<std::int64_t>::min()), "-9223372036854775808",
                           Primitive::int64),
            "-9223372036854775807 - 1");
  EXPECT_EQ(number_literal(Number(std::int64_t{-2147483648}), "-0x80000000", Primitive::int32),
            "-2147483648");
}

TEST(Literals, WrapNegativeValuesOfUnsignedTypes) {
  EXPECT_EQ(number_literal(Number(std::uint64_t{255}), "-1", Primitive::uint8), "255");
  EXPECT_EQ(number_literal(Number(std::uint64_t{4294967295U}), "-1", Primitive::uint32),
            "4294967295");
}

TEST(Literals, EscapeStrings) {
  EXPECT_EQ(string_literal("a\"b\\c\n\t"), R"("a\"b\\c\n\t")");
  EXPECT_EQ(string_literal(std::string_view("\0"
                                            "1",
                                            2)),
            R"("\0001")");
  EXPECT_EQ(string_literal("what?"
                           "?/"),
            "\"what?\\?/\"");
  EXPECT_EQ(string_literal("\xC3\xB6"), "\"\xC3\xB6\"");
}

TEST(Literals, PrintEnumValuesInTheirStyle) {
  model::EnumValue value;
  value.value = 16;
  EXPECT_EQ(enum_literal(value), "16");
  value.is_hexadecimal = true;
  EXPECT_EQ(enum_literal(value), "0x10");
  value.value = -31;
  EXPECT_EQ(enum_literal(value), "-0x1f");
  value.value = 0;
  EXPECT_EQ(enum_literal(value), "0x0");
  value.value = std::numeric_limits<std::int32_t>::min();
  EXPECT_EQ(enum_literal(value), "-2147483648");
}

TEST(LiteralText, KeepsAPlainTextInOnePiece) {
  EXPECT_THAT(literal_text("service a\n"), ElementsAre("R\"robdef(service a\n)robdef\""));
  EXPECT_THAT(literal_text(""), ElementsAre("\"\""));
}

TEST(LiteralText, WritesWhatRawLiteralsMayLoseAsEscapes) {
  EXPECT_THAT(literal_text("\xEF\xBB\xBF"
                           "a\r\nb"),
              ElementsAre(R"("\357\273\277")", "R\"robdef(a)robdef\"", R"("\r\n")",
                          "R\"robdef(b)robdef\""));
}

TEST(LiteralText, PicksADelimiterThatTheTextDoesNotHold) {
  EXPECT_THAT(literal_text("x)robdef\" y"), ElementsAre("R\"robdef_(x)robdef\" y)robdef_\""));
}

TEST(LiteralText, CutsLongTextsBehindLines) {
  std::string text;
  for (int i = 0; i < 4000; ++i) text += "0123456789\n";
  const std::vector<std::string> pieces = literal_text(text);
  EXPECT_EQ(pieces.size(), 3U);
  std::string joined;
  for (const std::string& piece : pieces) {
    EXPECT_LE(piece.size(), 16 * 1024U + 20);
    joined += piece.substr(9, piece.size() - 9 - 8);
  }
  EXPECT_EQ(joined, text);
}

}  // namespace
}  // namespace robdef::cpp
