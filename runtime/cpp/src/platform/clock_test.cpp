// SPDX-License-Identifier: Apache-2.0
#include "runtime/cpp/src/platform/clock.hpp"

#include <gtest/gtest.h>

#include <chrono>
#include <ctime>

namespace rr::platform {
namespace {

using Point = std::chrono::system_clock::time_point;

std::tm parts_of(int year, int month, int day, int hour, int minute, int second) {
  std::tm parts{};
  parts.tm_year = year - 1900;
  parts.tm_mon = month - 1;
  parts.tm_mday = day;
  parts.tm_hour = hour;
  parts.tm_min = minute;
  parts.tm_sec = second;
  return parts;
}

Point point(std::time_t seconds) { return std::chrono::system_clock::from_time_t(seconds); }

TEST(TimeOfUtc, IsTheOtherWayRound) {
  for (const std::time_t seconds : {std::time_t{0}, std::time_t{-1}, std::time_t{951'782'400},
                                    std::time_t{1'769'851'800}, std::time_t{4'102'444'799}}) {
    EXPECT_EQ(time_of_utc(utc(seconds)), point(seconds)) << seconds;
  }
}

TEST(TimeOfUtc, KnowsTheCalendar) {
  EXPECT_EQ(time_of_utc(parts_of(1970, 1, 1, 0, 0, 0)), point(0));
  EXPECT_EQ(time_of_utc(parts_of(2000, 2, 29, 0, 0, 0)), point(951'782'400));
  EXPECT_EQ(time_of_utc(parts_of(2026, 1, 31, 9, 30, 0)), point(1'769'851'800));
  EXPECT_EQ(time_of_utc(parts_of(1969, 12, 31, 23, 59, 59)), point(-1));
}

TEST(Utc, HasTheDaysOfTheWeekAndTheYear) {
  const std::tm parts = utc(951'782'400);  // a Tuesday, 29 February 2000
  EXPECT_EQ(parts.tm_wday, 2);
  EXPECT_EQ(parts.tm_yday, 59);
  EXPECT_EQ(utc(-1).tm_wday, 3);
  EXPECT_EQ(utc(-1).tm_yday, 364);
}

// As in certificates that are to be valid for ever.
TEST(TimeOfUtc, WhatATimePointCannotHold) {
  EXPECT_EQ(time_of_utc(parts_of(9999, 12, 31, 23, 59, 59)), Point::max());
  EXPECT_EQ(time_of_utc(parts_of(1600, 1, 1, 0, 0, 0)), Point::min());
}

TEST(UtcText, HasAsManyDecimalsAsAreAskedFor) {
  const Point time = point(1'769'851'800) + std::chrono::microseconds(125'678);
  EXPECT_EQ(utc_text(time, 3), "2026-01-31T09:30:00.125Z");
  EXPECT_EQ(utc_text(time, 6), "2026-01-31T09:30:00.125678Z");
  EXPECT_EQ(utc_text(point(-1), 1), "1969-12-31T23:59:59.0Z");
}

}  // namespace
}  // namespace rr::platform
