// SPDX-License-Identifier: Apache-2.0
#include <gtest/gtest.h>

#include <memory>
#include <utility>

#include "runtime/cpp/src/channel/slot_budget.hpp"

namespace rr::channel {
namespace {

TEST(SlotBudget, LimitsBytesAndNumber) {
  SlotBudget budget({.bytes = 100, .count = 2});
  EXPECT_FALSE(budget.draw(101));
  EXPECT_TRUE(budget.draw(60));
  EXPECT_FALSE(budget.draw(41));
  EXPECT_TRUE(budget.draw(0));
  EXPECT_FALSE(budget.draw(0)) << "a third one";
  EXPECT_EQ(budget.bytes(), 60U);
  EXPECT_EQ(budget.count(), 2U);
  budget.give_back(60);
  EXPECT_TRUE(budget.draw(100));
  EXPECT_EQ(budget.bytes(), 100U);
}

TEST(SlotShare, IsGivenBackOnce) {
  const auto budget = std::make_shared<SlotBudget>(SlotBudget::Limits{.bytes = 100, .count = 5});
  EXPECT_FALSE(SlotShare().is_drawn());
  {
    SlotShare first(budget, 70);
    EXPECT_TRUE(first.is_drawn());
    EXPECT_FALSE(SlotShare(budget, 31).is_drawn());
    SlotShare moved(std::move(first));
    EXPECT_TRUE(moved.is_drawn());
    SlotShare other(budget, 30);
    other = std::move(moved);
    EXPECT_TRUE(other.is_drawn());
    EXPECT_EQ(budget->bytes(), 100U);
  }
  EXPECT_EQ(budget->bytes(), 0U);
  EXPECT_EQ(budget->count(), 0U);
}

}  // namespace
}  // namespace rr::channel
