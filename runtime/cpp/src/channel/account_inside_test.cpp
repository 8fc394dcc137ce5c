// SPDX-License-Identifier: Apache-2.0
#include <gtest/gtest.h>

#include <memory>
#include <thread>
#include <vector>

#include "runtime/cpp/src/channel/account.hpp"

namespace rr::channel {
namespace {

constexpr std::size_t mib = 1024 * 1024;

std::shared_ptr<Pool> pool_of(std::size_t limit, std::size_t reserve = 0, std::size_t rests = 0) {
  return std::make_shared<Pool>(limit, reserve, rests);
}

using Accounts = std::vector<std::unique_ptr<Account>>;

Accounts accounts_of(const std::shared_ptr<Pool>& pool) {
  Accounts accounts;
  for (int i = 0; i < 20; ++i) accounts.push_back(std::make_unique<Account>(pool, no_limit));
  return accounts;
}

// In small steps and in turns, until all are refused.
void draw_all(Accounts& accounts, bool (Account::*draw)(std::size_t)) {
  bool goes_on = true;
  while (goes_on) {
    goes_on = false;
    for (auto& account : accounts) goes_on = ((*account).*draw)(64 * 1024) || goes_on;
  }
}

TEST(Account, OnePeerMayHoldTwoThirdsOfThePool) {
  const auto pool = pool_of(48 * mib);
  Account account(pool, no_limit);
  EXPECT_TRUE(account.draw(32 * mib));
  EXPECT_FALSE(account.draw(mib));
  EXPECT_EQ(account.held(), 32 * mib);
  EXPECT_EQ(pool->held(), 32 * mib);
}

TEST(Account, ManyPeersGetEqualShares) {
  const auto pool = pool_of(48 * mib);
  Accounts accounts = accounts_of(pool);
  draw_all(accounts, &Account::draw);
  for (auto& account : accounts) {
    EXPECT_GE(account->held(), 2 * mib);
    EXPECT_LE(account->held(), 5 * mib / 2);
  }
  EXPECT_LE(pool->held(), 48 * mib);
}

TEST(Account, ThoseThatHoldPartsDoNotWaitForEachOther) {
  constexpr std::size_t whole = 12 * mib;
  const auto pool = pool_of(39 * mib, 0, whole);
  Accounts accounts = accounts_of(pool);
  for (int finished = 0; finished < 20; ++finished) {
    draw_all(accounts, &Account::draw_part);
    bool has_finished = false;
    for (auto& account : accounts) {
      if (!account->draw_rest(whole - account->held())) continue;
      EXPECT_LE(pool->held(), 39 * mib);
      account = std::make_unique<Account>(pool, no_limit);  // done with; it begins anew
      has_finished = true;
      break;
    }
    ASSERT_TRUE(has_finished);
  }
}

TEST(Account, MessagesLeaveRoomForWhatIsReadFromThemAndThatForAnswers) {
  constexpr std::size_t largest = 12 * mib;
  const auto pool = pool_of(39 * mib, 0, largest);
  Accounts accounts = accounts_of(pool);
  for (auto& account : accounts) static_cast<void>(account->draw_rest(6 * mib));
  EXPECT_EQ(pool->held(), 18 * mib);  // half of it
  for (auto& account : accounts) static_cast<void>(account->draw_reading(6 * mib));
  EXPECT_EQ(pool->held(), 24 * mib);  // three quarters
  EXPECT_TRUE(accounts.back()->draw(6 * mib));
}

TEST(Account, OneOfTheLargestMessagesFitsIntoASmallPool) {
  const auto pool = pool_of(12 * mib, 0, 10 * mib);
  Account account(pool, no_limit);
  EXPECT_TRUE(account.draw_part(2 * mib));
  EXPECT_TRUE(account.draw_rest(8 * mib));
}

TEST(Account, HasItsOwnLimit) {
  Account account(pool_of(48 * mib), 100);
  EXPECT_TRUE(account.draw(100));
  EXPECT_FALSE(account.draw(1));
  account.give_back(50);
  EXPECT_TRUE(account.draw(50));
}

TEST(Account, HasAReserveWhenThePoolIsEmpty) {
  const auto pool = pool_of(mib, 64 * 1024);
  Account greedy(pool, no_limit);
  greedy.draw_anyway(2 * mib);
  Account modest(pool, no_limit);
  EXPECT_TRUE(modest.draw(64 * 1024));
  EXPECT_FALSE(modest.draw(1));
}

TEST(Account, GivesBackWhatItHoldsWhenItEnds) {
  const auto pool = pool_of(48 * mib);
  {
    Account account(pool, no_limit);
    EXPECT_TRUE(account.draw(mib));
    account.draw_anyway(100 * mib);
    EXPECT_EQ(pool->held(), 101 * mib);
  }
  EXPECT_EQ(pool->held(), 0U);
}

TEST(Account, KeepsAQuantumWhileItHoldsSomethingAndNothingOtherwise) {
  const auto pool = pool_of(48 * mib);
  Account account(pool, no_limit);
  EXPECT_TRUE(account.draw(10 * mib));
  account.give_back(10 * mib - 1);
  EXPECT_LE(pool->held(), 32 * 1024U);
  account.give_back(1);
  EXPECT_EQ(pool->held(), 0U);
}

TEST(Account, MovesToAnotherPoolWithWhatItHolds) {
  const auto strangers = pool_of(mib);
  const auto sessions = pool_of(48 * mib);
  Account account(strangers, no_limit);
  EXPECT_TRUE(account.draw(512 * 1024));
  EXPECT_FALSE(account.draw(512 * 1024));
  account.move_to(sessions);
  EXPECT_EQ(strangers->held(), 0U);
  EXPECT_EQ(sessions->held(), 512 * 1024U);
  EXPECT_TRUE(account.draw(mib));
}

TEST(Account, IsNeverMoreThanThePoolInManyThreads) {
  const auto pool = pool_of(mib);
  {
    std::vector<std::jthread> threads;
    for (int i = 0; i < 4; ++i) {
      threads.emplace_back([&] {
        Account account(pool, no_limit);
        for (int turn = 0; turn < 2000; ++turn) {
          if (account.draw(100'000)) account.give_back(100'000);
          EXPECT_LE(pool->held(), mib);
        }
      });
    }
  }
  EXPECT_EQ(pool->held(), 0U);
}

TEST(Charge, GivesBackOnceWhereverItIsMoved) {
  const auto pool = pool_of(48 * mib);
  const auto account = std::make_shared<Account>(pool, no_limit);
  {
    Charge first(account);
    EXPECT_TRUE(first.add(1000));
    Charge second(std::move(first));
    EXPECT_EQ(account->held(), 1000U);
    Charge third(account);
    EXPECT_TRUE(third.add(10));
    third = std::move(second);
    EXPECT_EQ(third.bytes(), 1000U);
    third.reduce(400);
    EXPECT_EQ(account->held(), 610U);  // the other one has not ended yet
  }
  EXPECT_EQ(account->held(), 0U);
}

TEST(Charge, WithoutAnAccountHasNoLimit) {
  Charge charge;
  EXPECT_TRUE(charge.add(100 * mib));
  EXPECT_EQ(charge.bytes(), 100 * mib);
}

TEST(Account, WhatIsOfferedIsDrawnOnceMore) {
  const auto pool = pool_of(10 * mib);
  const auto account = std::make_shared<Account>(pool, no_limit);
  Account other(pool, no_limit);
  Charge made(account);
  ASSERT_TRUE(made.add(6 * mib));
  ASSERT_TRUE(other.draw(1 * mib));
  Charge sent(account);
  EXPECT_FALSE(sent.add(5 * mib));
  {
    const OfferedCharge offer(std::move(made));
    EXPECT_EQ(made.bytes(), 0U);  // NOLINT(bugprone-use-after-move): is empty then
    EXPECT_TRUE(sent.add(5 * mib));
    EXPECT_EQ(account->held(), 6 * mib);
    EXPECT_FALSE(sent.add(5 * mib));  // 1 MiB is left, and the pool has not 4
    EXPECT_EQ(account->held(), 6 * mib);
  }
  EXPECT_EQ(account->held(), 5 * mib);
  sent.clear();
  EXPECT_EQ(account->held(), 0U);
}

TEST(Account, WhatIsOfferedAndNotDrawnIsGivenBack) {
  const auto pool = pool_of(10 * mib);
  const auto account = std::make_shared<Account>(pool, no_limit);
  Charge made(account);
  ASSERT_TRUE(made.add(6 * mib));
  { const OfferedCharge offer(std::move(made)); }
  EXPECT_EQ(account->held(), 0U);
  EXPECT_EQ(pool->held(), 0U);
}

TEST(Pool, SaysWhenItFallsAndWhenItRefuses) {
  Pool pool(10 * mib, 0);
  std::vector<std::size_t> fallen;
  int refused = 0;
  pool.set_on_fall(2 * mib, [&](std::size_t bytes) { fallen.push_back(bytes); });
  pool.set_on_full([&] { ++refused; });
  EXPECT_EQ(pool.limit(), 10 * mib);
  Account account(std::shared_ptr<Pool>(std::shared_ptr<void>(), &pool), no_limit);
  ASSERT_TRUE(account.draw(6 * mib));
  EXPECT_EQ(refused, 0);
  EXPECT_FALSE(account.draw(5 * mib));
  EXPECT_GE(refused, 1);
  account.give_back(mib);
  EXPECT_TRUE(fallen.empty());
  account.give_back(5 * mib);
  ASSERT_EQ(fallen.size(), 1U);
  EXPECT_EQ(fallen.front(), 6 * mib);
}

TEST(Account, WhatMayNeverComeLeavesThreeQuartersOfThePool) {
  const auto pool = pool_of(16 * mib);
  Account account(pool, no_limit);
  EXPECT_TRUE(account.draw_ahead(3 * mib));
  EXPECT_FALSE(account.draw_ahead(2 * mib));
  EXPECT_TRUE(account.draw(2 * mib)) << "others may";
}

TEST(Account, WhatHandlersMakeLeavesASixteenth) {
  const auto pool = pool_of(16 * mib);
  Accounts accounts = accounts_of(pool);
  draw_all(accounts, &Account::draw_making);
  EXPECT_LE(pool->held(), 15 * mib);
  EXPECT_GE(pool->held(), 13 * mib);
  Account other(pool, no_limit);
  EXPECT_FALSE(other.draw_making(mib / 2 + 1));
  EXPECT_TRUE(other.draw(mib / 4)) << "for answers";
}

TEST(Account, AnOfferEnds) {
  const auto pool = pool_of(16 * mib);
  Account account(pool, no_limit);
  ASSERT_TRUE(account.draw(4 * mib));
  account.offer(4 * mib);
  EXPECT_EQ(account.held(), 4 * mib);
  EXPECT_TRUE(account.draw(3 * mib)) << "once more";
  EXPECT_EQ(account.held(), 4 * mib);
  account.end_offer(4 * mib);
  EXPECT_EQ(account.held(), 3 * mib);
}

TEST(Charge, DrawsForEachUseAsItsAccountDoes) {
  const auto pool = pool_of(16 * mib);
  const auto account = std::make_shared<Account>(pool, no_limit);
  EXPECT_FALSE(Charge().has_account());
  Charge charge(account);
  EXPECT_TRUE(charge.has_account());
  EXPECT_TRUE(charge.add_part(mib));
  EXPECT_TRUE(charge.add_rest(mib));
  EXPECT_TRUE(charge.add_reading(mib));
  EXPECT_TRUE(charge.add_making(mib));
  EXPECT_EQ(charge.bytes(), 4 * mib);
  EXPECT_FALSE(charge.add_ahead(mib)) << "a quarter of the pool is taken";
  EXPECT_TRUE(charge.can_add(6 * mib));
  EXPECT_FALSE(charge.can_add(7 * mib)) << "two thirds are for one";
  EXPECT_EQ(account->held(), 4 * mib);
  charge.add_anyway(100 * mib);
  EXPECT_EQ(charge.bytes(), 104 * mib);
  EXPECT_EQ(account->held(), 104 * mib);
  EXPECT_FALSE(charge.add_part(1));
  EXPECT_FALSE(charge.add_rest(1));
  EXPECT_FALSE(charge.add_reading(1));
  EXPECT_FALSE(charge.add_making(1));
  EXPECT_EQ(charge.bytes(), 104 * mib);
  Charge free_of_limits;
  EXPECT_TRUE(free_of_limits.add_ahead(100 * mib));
  EXPECT_TRUE(free_of_limits.can_add(100 * mib));
}

}  // namespace
}  // namespace rr::channel
