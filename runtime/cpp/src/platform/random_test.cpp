// SPDX-License-Identifier: Apache-2.0
#include "runtime/cpp/src/platform/random.hpp"

#include <gtest/gtest.h>

#include <array>
#include <cstddef>
#include <set>
#include <span>

namespace rr::platform {
namespace {

TEST(Random, FillsAllOfTheBytesAndNoMore) {
  // A byte that stays zero in 64 fills is one that is not written.
  std::array<std::byte, 258> bytes{};
  std::array<std::byte, 258> seen{};
  for (int i = 0; i < 64; ++i) {
    fill_random(std::span(bytes).subspan(1, 256));
    for (std::size_t k = 0; k < bytes.size(); ++k) seen[k] |= bytes[k];
  }
  EXPECT_EQ(seen.front(), std::byte{0});
  EXPECT_EQ(seen.back(), std::byte{0});
  for (std::size_t k = 1; k <= 256; ++k) EXPECT_NE(seen[k], std::byte{0}) << k;
  fill_random({});
}

TEST(Random, NumbersDiffer) {
  const RandomNumbers numbers;
  std::set<std::uint32_t> seen;
  for (int i = 0; i < 100; ++i) seen.insert(numbers());
  EXPECT_GT(seen.size(), 95U);
}

}  // namespace
}  // namespace rr::platform
