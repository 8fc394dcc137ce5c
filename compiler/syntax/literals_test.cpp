// SPDX-License-Identifier: Apache-2.0
#include "compiler/syntax/literals.hpp"

#include <gtest/gtest.h>

#include <string>

namespace robdef::syntax {
namespace {

TEST(Literals, IntegersFitTheirRangeExactly) {
  const auto fit = [](std::string_view text, bool is_signed, int bits) {
    return fits(read_integer(text), is_signed, bits);
  };
  EXPECT_TRUE(fit("127", true, 8));
  EXPECT_FALSE(fit("128", true, 8));
  EXPECT_TRUE(fit("-128", true, 8));
  EXPECT_FALSE(fit("-129", true, 8));
  EXPECT_TRUE(fit("255", false, 8));
  EXPECT_FALSE(fit("256", false, 8));
  EXPECT_TRUE(fit("0x7FFFFFFF", true, 32));
  EXPECT_FALSE(fit("0xFFFFFFFF", true, 32));
  EXPECT_TRUE(fit("-0x80000000", true, 32));
  EXPECT_TRUE(fit("+5", true, 8));
  EXPECT_TRUE(fit("18446744073709551615", false, 64));
  EXPECT_FALSE(fit("18446744073709551616", false, 64));
  EXPECT_TRUE(fit("-9223372036854775808", true, 64));
  EXPECT_FALSE(fit("9223372036854775808", true, 64));
  EXPECT_FALSE(fit(std::string(100'000, '9'), false, 64));
}

TEST(Literals, FloatingPointNumbersOverflowAndUnderflow) {
  EXPECT_EQ(fit_float("5", false), FloatFit::fits);
  EXPECT_EQ(fit_float("+.5", false), FloatFit::fits);
  EXPECT_EQ(fit_float("-5.", false), FloatFit::fits);
  EXPECT_EQ(fit_float("0e999999999999999999999", false), FloatFit::fits);
  EXPECT_EQ(fit_float("1e308", false), FloatFit::fits);
  EXPECT_EQ(fit_float("1e309", false), FloatFit::overflows);
  EXPECT_EQ(fit_float("-1e400", false), FloatFit::overflows);
  EXPECT_EQ(fit_float("1e39", true), FloatFit::overflows);
  EXPECT_EQ(fit_float("1e39", false), FloatFit::fits);
  EXPECT_EQ(fit_float("1e-400", false), FloatFit::underflows);
  EXPECT_EQ(fit_float("1e-60", true), FloatFit::underflows);
  EXPECT_EQ(fit_float("0." + std::string(500, '0') + "1", false), FloatFit::underflows);
  EXPECT_EQ(fit_float(std::string(500, '9'), false), FloatFit::overflows);
  EXPECT_EQ(fit_float("1e99999999999999999999", false), FloatFit::overflows);
  EXPECT_EQ(fit_float("1e-99999999999999999999", false), FloatFit::underflows);
}

TEST(Literals, EscapesBecomeUtf8) {
  StringFault fault;
  EXPECT_EQ(read_string(R"("a\"\\\/\b\f\n\r\tz")", fault), "a\"\\/\b\f\n\r\tz");
  EXPECT_EQ(read_string(R"("\u0041\u00e9\u20AC")", fault), "A\xC3\xA9\xE2\x82\xAC");
  EXPECT_EQ(read_string(R"("\ud83d\ude00!")", fault), "\xF0\x9F\x98\x80!");
  EXPECT_EQ(read_string(R"("\u0000")", fault), std::string(1, '\0'));
  EXPECT_EQ(read_string(R"("")", fault), "");
}

TEST(Literals, HalfASurrogatePairIsAFault) {
  StringFault fault;
  EXPECT_EQ(read_string(R"("ab\ud83d")", fault), std::nullopt);
  EXPECT_EQ(fault.begin, 3U);
  EXPECT_EQ(fault.end, 9U);
  EXPECT_EQ(read_string(R"("\ud83d\u0041")", fault), std::nullopt);
  EXPECT_EQ(read_string(R"("\ude00")", fault), std::nullopt);
}

TEST(Literals, WrongEscapesAndMissingQuotesAreFound) {
  const StringFault escape = find_string_fault(R"("ab\"\u00e9\q")");
  EXPECT_FALSE(escape.is_unclosed);
  EXPECT_EQ(escape.begin, 11U);
  EXPECT_EQ(escape.end, 13U);
  EXPECT_EQ(find_string_fault(R"("\u00g0")").begin, 1U);
  EXPECT_TRUE(find_string_fault(R"("ab)").is_unclosed);
  EXPECT_EQ(find_string_fault("\"ab\\").begin, 3U);
}

}  // namespace
}  // namespace robdef::syntax
