// SPDX-License-Identifier: Apache-2.0
#include "rr/realtime/lookup_table.hpp"

#include <gtest/gtest.h>

#include <array>
#include <atomic>
#include <functional>
#include <limits>
#include <thread>
#include <vector>

#include "rr/error.hpp"

namespace rr::realtime {
namespace {

std::array<double, 2> at(const LookupTable& table, double time) {
  std::array<double, 2> positions{-1, -1};
  EXPECT_TRUE(table.read(time, positions));
  return positions;
}

ErrorCode loading_fails_with(LookupTable& table, const std::vector<double>& times,
                             const std::vector<double>& positions) {
  try {
    table.load(times, positions);
  } catch (const Error& error) {
    return error.code();
  }
  return ErrorCode::none;
}

TEST(RealtimeTable, InterpolatesBetweenRowsAndHoldsTheEnds) {
  LookupTable table(2, 3);
  std::array<double, 2> positions{9, 9};
  EXPECT_FALSE(table.read(0, positions)) << "there is none yet";
  EXPECT_EQ(positions[0], 9);
  EXPECT_EQ(table.load(std::vector{1.0, 2.0, 4.0}, std::vector{0.0, 10.0, 1.0, 20.0, 3.0, 0.0}),
            1U);
  EXPECT_TRUE(table.begin_sample(0));
  EXPECT_FALSE(table.begin_sample(1));
  EXPECT_EQ(at(table, 0), (std::array{0.0, 10.0}));
  EXPECT_EQ(at(table, 1), (std::array{0.0, 10.0}));
  EXPECT_EQ(at(table, 1.5), (std::array{0.5, 15.0}));
  EXPECT_EQ(at(table, 3), (std::array{2.0, 10.0}));
  EXPECT_EQ(at(table, 5), (std::array{3.0, 0.0}));
  EXPECT_EQ(table.end_time(), 4);
}

TEST(RealtimeTable, HoldsRowsWhenAskedTo) {
  LookupTable table(2, 3, LookupTable::Interpolation::hold);
  table.load(std::vector{0.0, 1.0}, std::vector{1.0, 2.0, 3.0, 4.0});
  table.begin_sample(0);
  EXPECT_EQ(at(table, 0.999), (std::array{1.0, 2.0}));
  EXPECT_EQ(at(table, 1), (std::array{3.0, 4.0}));
}

TEST(RealtimeTable, ChangesAtTheChosenSampleAndNotBefore) {
  LookupTable table(2, 2);
  table.load(std::vector{0.0}, std::vector{1.0, 1.0});
  table.begin_sample(0);
  table.load(std::vector{0.0}, std::vector{2.0, 2.0}, 10);
  EXPECT_FALSE(table.begin_sample(9));
  EXPECT_EQ(at(table, 0)[0], 1);
  table.load(std::vector{0.0}, std::vector{3.0, 3.0}, 12);  // in the place of the one that waits
  EXPECT_FALSE(table.begin_sample(10));
  EXPECT_FALSE(table.begin_sample(11));
  EXPECT_TRUE(table.begin_sample(12));
  EXPECT_EQ(at(table, 0)[0], 3);
  EXPECT_EQ(table.current(), 3U);
}

TEST(RealtimeTable, RefusesTablesThatAreWrongAndKeepsTheOldOne) {
  LookupTable table(2, 2);
  table.load(std::vector{0.0}, std::vector{1.0, 1.0});
  const double nan = std::numeric_limits<double>::quiet_NaN();
  EXPECT_EQ(loading_fails_with(table, {}, {}), ErrorCode::invalid_argument);
  EXPECT_EQ(loading_fails_with(table, {0}, {1}), ErrorCode::invalid_argument);
  EXPECT_EQ(loading_fails_with(table, {0, 0}, {1, 1, 2, 2}), ErrorCode::invalid_argument);
  EXPECT_EQ(loading_fails_with(table, {0, nan}, {1, 1, 2, 2}), ErrorCode::invalid_argument);
  EXPECT_EQ(loading_fails_with(table, {0}, {nan, 1}), ErrorCode::invalid_argument);
  EXPECT_EQ(loading_fails_with(table, {0, 1, 2}, std::vector<double>(6)), ErrorCode::out_of_range);
  EXPECT_THROW(LookupTable(0, 1), Error);
  table.begin_sample(0);
  EXPECT_EQ(at(table, 0)[0], 1);
}

TEST(RealtimeTable, IsNeverAMixtureOfTwo) {
  constexpr std::size_t rows = 50;
  LookupTable table(2, rows);
  std::atomic<bool> is_over{false};
  std::thread loader([&] {
    for (double number = 1; !is_over.load(std::memory_order_relaxed); ++number) {
      std::vector<double> times;
      for (std::size_t i = 0; i < rows; ++i) times.push_back(static_cast<double>(i));
      table.load(times, std::vector<double>(2 * rows, number));
    }
  });
  int mixed = 0;
  double newest = 0;
  for (std::uint64_t sample = 0; sample < 20'000; ++sample) {
    table.begin_sample(sample);
    std::array<double, 2> first{};
    std::array<double, 2> last{};
    if (!table.read(0.5, first) || !table.read(rows - 1.5, last)) continue;
    mixed += first == last && first[0] == first[1] && first[0] >= newest ? 0 : 1;
    newest = first[0];
  }
  is_over = true;
  loader.join();
  EXPECT_EQ(mixed, 0);
}

}  // namespace
}  // namespace rr::realtime
