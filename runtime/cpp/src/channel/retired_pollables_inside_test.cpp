// SPDX-License-Identifier: Apache-2.0
#include <gtest/gtest.h>

#include <cstdint>
#include <memory>
#include <utility>

#include "runtime/cpp/src/channel/reactor.hpp"
#include "runtime/cpp/src/channel/retired_pollables.hpp"

namespace rr::channel {
namespace {

class Idle final : public Pollable {
 public:
  void on_ready(std::uint32_t) override {}
};

TEST(RetiredPollables, AreKeptUntilTheyAreTaken) {
  RetiredPollables retired;
  EXPECT_TRUE(retired.empty());
  auto one = std::make_shared<Idle>();
  const std::weak_ptr<Idle> watch = one;
  EXPECT_TRUE(retired.add(std::move(one)));
  EXPECT_FALSE(retired.empty());
  EXPECT_FALSE(watch.expired());
  EXPECT_EQ(retired.take().size(), 1U);
  EXPECT_TRUE(watch.expired());
  EXPECT_TRUE(retired.empty());
}

TEST(RetiredPollables, AreKeptWhileAThreadIsInside) {
  RetiredPollables retired;
  const auto busy = std::make_shared<Idle>();
  const auto idle = std::make_shared<Idle>();
  retired.enter(busy.get());
  retired.enter(busy.get());  // two threads
  ASSERT_TRUE(retired.add(busy));
  ASSERT_TRUE(retired.add(idle));
  RetiredPollables::Pollables taken = retired.take();
  ASSERT_EQ(taken.size(), 1U);
  EXPECT_EQ(taken.front(), idle);
  retired.leave(busy.get());
  EXPECT_TRUE(retired.take().empty()) << "one is still there";
  retired.leave(busy.get());
  taken = retired.take();
  ASSERT_EQ(taken.size(), 1U);
  EXPECT_EQ(taken.front(), busy);
}

TEST(RetiredPollables, AreNotKeptAfterTheEnd) {
  RetiredPollables retired;
  const auto one = std::make_shared<Idle>();
  retired.enter(one.get());
  ASSERT_TRUE(retired.add(one));
  EXPECT_EQ(retired.end().size(), 1U);
  std::shared_ptr<Pollable> late = one;
  EXPECT_FALSE(retired.add(std::move(late)));
  EXPECT_EQ(late, one) << "its destructor may need the lock that the caller has";
  EXPECT_TRUE(retired.empty());
}

}  // namespace
}  // namespace rr::channel
