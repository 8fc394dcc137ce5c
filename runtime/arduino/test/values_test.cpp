// SPDX-License-Identifier: Apache-2.0
#include <gtest/gtest.h>

#include <bit>
#include <cmath>
#include <cstring>
#include <limits>
#include <random>

#include "runtime/arduino/test/wired_board.hpp"

namespace rr {
namespace {

TEST(Values, AreLittleEndianAndPacked) {
  uint8_t bytes[32];
  Writer writer(bytes, sizeof bytes);
  EXPECT_TRUE(write(writer, static_cast<int16_t>(-2)));
  EXPECT_TRUE(write(writer, static_cast<uint32_t>(0x01020304)));
  EXPECT_TRUE(write(writer, true));
  EXPECT_TRUE(write(writer, 1.0));
  EXPECT_EQ(std::vector<uint8_t>(bytes, bytes + writer.count()),
            testing::bytes_of({0xFE, 0xFF, 4, 3, 2, 1, 1, 0, 0, 0, 0, 0, 0, 0xF0, 0x3F}));
}

TEST(Values, ATruthIsZeroOrOne) {
  const uint8_t bytes[] = {1, 2};
  Reader reader(bytes, 2);
  bool value = false;
  EXPECT_TRUE(read(reader, value));
  EXPECT_TRUE(value);
  EXPECT_FALSE(read(reader, value));
}

TEST(Values, NothingIsReadBehindTheEnd) {
  const uint8_t bytes[] = {1, 2, 3};
  Reader reader(bytes, 3);
  uint32_t value = 9;
  EXPECT_FALSE(read(reader, value));
  uint8_t byte = 9;
  EXPECT_FALSE(read(reader, byte)) << "once something was missing, all is";
  EXPECT_EQ(byte, 9);
}

TEST(Values, WhatDoesNotFitIsNotWritten) {
  uint8_t bytes[3];
  Writer writer(bytes, 3);
  EXPECT_TRUE(write(writer, static_cast<uint16_t>(1)));
  EXPECT_FALSE(write(writer, static_cast<uint16_t>(1)));
  EXPECT_FALSE(write(writer, static_cast<uint8_t>(1)));
  EXPECT_FALSE(writer.isGood());
}

TEST(Values, StringsHaveALimit) {
  const uint8_t bytes[] = {3, 'a', 'b', 'c'};
  Reader fits(bytes, 4);
  Text<3> text;
  EXPECT_TRUE(read(fits, text));
  EXPECT_STREQ(text.c_str(), "abc");
  Reader is_long(bytes, 4);
  Text<2> shorter;
  EXPECT_FALSE(read(is_long, shorter));
  EXPECT_EQ(is_long.refusal(), Status::BufferLimitViolation);
  text = "abcdef";
  EXPECT_EQ(text.length(), 3);
}

TEST(Values, AStringWithAZeroIsRefused) {
  const uint8_t bytes[] = {2, 'a', 0};
  Reader reader(bytes, 3);
  Text<4> text;
  EXPECT_FALSE(read(reader, text));
  EXPECT_EQ(reader.refusal(), Status::DataTypeMismatch);
}

TEST(Values, BoundedArraysSayHowManyThereAre) {
  Bounded<int16_t, 3> items;
  EXPECT_TRUE(items.add(5));
  EXPECT_TRUE(items.add(-1));
  uint8_t bytes[8];
  Writer writer(bytes, sizeof bytes);
  EXPECT_TRUE(write(writer, items));
  EXPECT_EQ(std::vector<uint8_t>(bytes, bytes + writer.count()),
            testing::bytes_of({2, 5, 0, 0xFF, 0xFF}));
  bytes[0] = 4;
  Reader reader(bytes, 5);
  EXPECT_FALSE(read(reader, items)) << "more than the limit";
}

uint32_t narrow_bits(uint64_t bits) {
  uint8_t wide[8];
  for (int at = 0; at < 8; ++at) wide[at] = static_cast<uint8_t>(bits >> (8 * at));
  return narrow(wide);
}
uint64_t widen_bits(uint32_t single) {
  uint8_t wide[8];
  widen(single, wide);
  uint64_t bits = 0;
  for (int at = 0; at < 8; ++at) bits |= static_cast<uint64_t>(wide[at]) << (8 * at);
  return bits;
}

/// What the processor makes of a double.
uint32_t narrowed(double value) { return std::bit_cast<uint32_t>(static_cast<float>(value)); }

TEST(Doubles, AreRoundedAsAProcessorDoes) {
  std::mt19937_64 random(1);
  for (int count = 0; count < 2'000'000; ++count) {
    uint64_t bits = random();
    // Half of them near what a float can say, where it matters.
    if (count % 2 == 0) {
      bits = (bits & 0x800FFFFFFFFFFFFF) | ((1023 - 160 + random() % 300) << 52);
      if (count % 4 == 0) bits &= ~0x1FFFFFFFULL | (random() % 2 << 28);
    }
    const double value = std::bit_cast<double>(bits);
    if (std::isnan(value)) continue;
    ASSERT_EQ(narrow_bits(bits), narrowed(value)) << std::hexfloat << value;
  }
}

TEST(Doubles, EdgesAreRight) {
  for (const double value :
       {0.0, -0.0, 1.0, -1.5, 0x1p-126, 0x1p-149, 0x1p-150, 0x1.8p-150, 0x1.000002p-127, 0x1p-151,
        3.4028234663852886e38, 3.4028235677973366e38, 1e39, -1e300, 5e-324,
        std::numeric_limits<double>::infinity(), 0x1.FFFFFEp-127, 0x1.FFFFFFp-127}) {
    EXPECT_EQ(narrow_bits(std::bit_cast<uint64_t>(value)), narrowed(value))
        << std::hexfloat << value;
  }
  const uint32_t nan = narrow_bits(std::bit_cast<uint64_t>(std::nan("")));
  EXPECT_TRUE(std::isnan(std::bit_cast<float>(nan)));
  EXPECT_TRUE(std::isnan(std::bit_cast<float>(narrow_bits(0x7FF0000000000001))));
}

TEST(Doubles, OfFloatsAreExact) {
  std::mt19937 random(1);
  for (int count = 0; count < 1'000'000; ++count) {
    auto bits = static_cast<uint32_t>(random());
    if (count % 3 == 0) bits &= 0x807FFFFF;
    const float value = std::bit_cast<float>(bits);
    if (std::isnan(value)) continue;
    ASSERT_EQ(widen_bits(bits), std::bit_cast<uint64_t>(static_cast<double>(value)));
    ASSERT_EQ(narrow_bits(widen_bits(bits)), bits);
  }
}

}  // namespace
}  // namespace rr
