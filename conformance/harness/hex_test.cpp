// SPDX-License-Identifier: Apache-2.0
#include "conformance/harness/hex.hpp"

#include <gtest/gtest.h>

#include <stdexcept>

namespace rr::conformance {
namespace {

TEST(Hex, BytesComeBackAsTheSameText) {
  EXPECT_EQ(hex_of_bytes(bytes_of_hex("00ff10a5")), "00ff10a5");
}

TEST(Hex, APlaceholderStandsForManyBytes) {
  EXPECT_EQ(hex_of_bytes(bytes_of_hex("01{ab*3}02")), "01ababab02");
}

TEST(Hex, ANameStandsForTheTextOfTheBlob) {
  const Blobs blobs = {{"a.b", "xy\n"}};
  EXPECT_EQ(hex_of_bytes(bytes_of_hex("01{a.b}", blobs)), "0178790a");
}

TEST(Hex, WhatIsNoHexIsRefused) {
  EXPECT_THROW(bytes_of_hex("0"), std::runtime_error);
  EXPECT_THROW(bytes_of_hex("0g"), std::runtime_error);
  EXPECT_THROW(bytes_of_hex("{no.such}"), std::runtime_error);
  EXPECT_THROW(bytes_of_hex("{ab*3"), std::runtime_error);
}

TEST(Hex, Utf8IsToldFromOtherBytes) {
  EXPECT_TRUE(is_utf8("caf\xC3\xA9 \xF0\x9F\xA4\x96"));
  EXPECT_FALSE(is_utf8("\xC3("));
  EXPECT_FALSE(is_utf8("\xC0\x80"));
  EXPECT_FALSE(is_utf8("\xED\xA0\x80"));
  EXPECT_FALSE(is_utf8("\xE6\x97"));
}

}  // namespace
}  // namespace rr::conformance
