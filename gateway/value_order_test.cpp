// SPDX-License-Identifier: Apache-2.0
#include "gateway/value_order.hpp"

#include <gtest/gtest.h>

namespace rr::gateway {
namespace {

using std::chrono::seconds;

TEST(GatewayValueOrder, AnOlderNumberIsNotTaken) {
  ValueOrder order;
  const auto now = ValueOrder::Clock::now();
  EXPECT_TRUE(order.take(7, 5, now));
  EXPECT_FALSE(order.take(7, 5, now));
  EXPECT_FALSE(order.take(7, 4, now));
  EXPECT_TRUE(order.take(7, 9, now));
  EXPECT_FALSE(order.take(7, 6, now));
}

TEST(GatewayValueOrder, TheNextGatewayCountsAnew) {
  ValueOrder order;
  const auto now = ValueOrder::Clock::now();
  EXPECT_TRUE(order.take(7, 5, now));
  EXPECT_TRUE(order.take(8, 1, now));
  EXPECT_FALSE(order.take(8, 1, now));
  EXPECT_TRUE(order.take(8, 2, now));
}

TEST(GatewayValueOrder, ValuesOfAGatewayThatHasEndedAreNotTaken) {
  ValueOrder order;
  auto now = ValueOrder::Clock::now();
  EXPECT_TRUE(order.take(7, 5, now));
  EXPECT_TRUE(order.take(8, 1, now));
  EXPECT_FALSE(order.take(7, 6, now));
  EXPECT_TRUE(order.take(9, 1, now));
  now += seconds(59);
  EXPECT_FALSE(order.take(7, 7, now));
  EXPECT_FALSE(order.take(8, 7, now));
  EXPECT_TRUE(order.take(9, 2, now));
  // It has the node again after all.
  now += seconds(1);
  EXPECT_TRUE(order.take(7, 8, now));
  EXPECT_FALSE(order.take(9, 3, now));
}

TEST(GatewayValueOrder, KnowsALimitedNumberOfGateways) {
  ValueOrder order;
  const auto now = ValueOrder::Clock::now();
  for (std::uint64_t epoch = 1; epoch <= 10; ++epoch) EXPECT_TRUE(order.take(epoch, 1, now));
  for (std::uint64_t epoch = 2; epoch <= 9; ++epoch) EXPECT_FALSE(order.take(epoch, 2, now));
  EXPECT_TRUE(order.take(1, 2, now));
}

}  // namespace
}  // namespace rr::gateway
