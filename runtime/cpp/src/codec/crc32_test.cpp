// SPDX-License-Identifier: Apache-2.0
#include "rr/crc32.hpp"

#include <gtest/gtest.h>

#include <string_view>

namespace rr {
namespace {

std::span<const std::byte> bytes_of(std::string_view text) {
  return std::as_bytes(std::span(text.data(), text.size()));
}

// The check value that catalogues of such sums name for this polynomial.
TEST(Crc32, IsThatOfTheStandard) {
  EXPECT_EQ(crc32({}), 0U);
  EXPECT_EQ(crc32(bytes_of("123456789")), 0xCBF43926U);
}

TEST(Crc32, GoesOnFromWhatCameBefore) {
  constexpr std::string_view text = "What is summed in two parts has the same sum.";
  for (std::size_t cut = 0; cut <= text.size(); ++cut) {
    EXPECT_EQ(crc32(bytes_of(text.substr(cut)), crc32(bytes_of(text.substr(0, cut)))),
              crc32(bytes_of(text)));
  }
}

}  // namespace
}  // namespace rr
