// SPDX-License-Identifier: Apache-2.0
#include <gtest/gtest.h>

#include <chrono>
#include <memory>
#include <string>

#include "runtime/cpp/src/endpoint/newest_value.hpp"
#include "runtime/cpp/src/endpoint/sender_clock.hpp"

namespace rr::endpoint {
namespace {

std::shared_ptr<const void> value(int number) { return std::make_shared<const int>(number); }

TEST(NewestValue, MayHaveArrivedBefore) {
  NewestValue newest;
  newest.set_lifespan(std::chrono::milliseconds(1000));
  const channel::Time now = channel::Clock::now();
  EXPECT_EQ(newest.put(value(1), Arrival({1, 2}, now - std::chrono::hours(1))), nullptr);
  EXPECT_FALSE(newest.is_fresh());
  EXPECT_EQ(newest.time(), (TimeSpec{1, 2}));
  newest.put(value(2), Arrival({1, 3}, now));
  newest.set_lifespan(std::chrono::hours(1));
  EXPECT_TRUE(newest.is_fresh());
}

TEST(NewestValue, IsWhatHasComeLast) {
  NewestValue newest;
  TimeSpec time;
  EXPECT_EQ(newest.get(time), nullptr);
  EXPECT_FALSE(newest.is_fresh());
  const auto first = value(1);
  EXPECT_EQ(newest.put(first, {1, 2}), nullptr);
  EXPECT_TRUE(newest.is_fresh());
  EXPECT_EQ(newest.get(time), first);
  EXPECT_EQ(time, (TimeSpec{1, 2}));
  const auto second = value(2);
  EXPECT_EQ(newest.put(second, {3, 4}), first) << "for the caller to free";
  EXPECT_EQ(newest.value(), second);
  EXPECT_EQ(newest.time(), (TimeSpec{3, 4}));
  EXPECT_EQ(newest.take(), second);
  EXPECT_EQ(newest.value(), nullptr);
  EXPECT_EQ(newest.time(), (TimeSpec{3, 4})) << "stays";
}

TEST(NewestValue, ExpiresAfterItsLifespan) {
  NewestValue newest;
  newest.set_lifespan(channel::Milliseconds(1));
  newest.put(value(1), {});
  const channel::Time arrived = channel::Clock::now();
  while (channel::Clock::now() - arrived <= channel::Milliseconds(1)) {
  }
  TimeSpec time;
  EXPECT_FALSE(newest.is_fresh());
  EXPECT_EQ(newest.get(time), nullptr);
  EXPECT_NE(newest.value(), nullptr) << "whatever its age";
  newest.set_lifespan(channel::Milliseconds(0));
  EXPECT_TRUE(newest.is_fresh());
}

TEST(NewestValue, TimesAreComparedToTheNanosecond) {
  EXPECT_TRUE(is_later({2, 0}, {1, 999'999'999}));
  EXPECT_TRUE(is_later({1, 2}, {1, 1}));
  EXPECT_FALSE(is_later({1, 1}, {1, 1}));
  EXPECT_FALSE(is_later({-1, 5}, {0, 0}));
}

TEST(SenderClock, CountsFromTheTimeOfDay) {
  const SenderClock clock;
  const auto now = [] {
    return std::chrono::nanoseconds(std::chrono::system_clock::now().time_since_epoch()).count();
  };
  const SenderTime first = clock.now();
  EXPECT_GE(clock.now(), first);
  EXPECT_LT(std::abs(now() - first), 60'000'000'000) << "about the time of day";
  EXPECT_EQ(as_time_spec(1'500'000'000), (TimeSpec{1, 500'000'000}));
  EXPECT_EQ(as_time_spec(0), (TimeSpec{0, 0}));
}

TEST(SenderTimes, EachIsLaterThanThoseBefore) {
  const SenderClock clock;
  SenderTimes times;
  SenderTime last = 0;
  for (int i = 0; i < 10'000; ++i) {
    const SenderTime next = times.draw(clock);
    ASSERT_GT(next, last);
    last = next;
  }
}

}  // namespace
}  // namespace rr::endpoint
