// SPDX-License-Identifier: Apache-2.0
#include "rr/realtime/lookup_table.hpp"

#include <algorithm>
#include <cmath>
#include <string>

#include "rr/error.hpp"

namespace rr::realtime {

struct LookupTable::Table {
  std::vector<double> times;
  std::vector<double> positions;
  std::size_t size = 0;
  std::uint64_t number = 0;
  std::uint64_t at_sample = 0;
};

LookupTable::LookupTable(std::size_t width, std::size_t capacity, Interpolation interpolation)
    : width_(width), capacity_(capacity), interpolation_(interpolation), tables_(4) {
  if (width == 0 || capacity == 0) {
    throw Error(ErrorCode::invalid_argument, "a lookup table without rows or without positions");
  }
  for (Table& table : tables_) {
    table.times.resize(capacity);
    table.positions.resize(capacity * width);
  }
}

LookupTable::~LookupTable() = default;

std::uint64_t LookupTable::load(std::span<const double> times, std::span<const double> positions,
                                std::uint64_t at_sample) {
  if (times.size() > capacity_) {
    throw Error(ErrorCode::out_of_range, "a lookup table of " + std::to_string(times.size()) +
                                             " rows, where there is room for " +
                                             std::to_string(capacity_));
  }
  if (times.empty() || positions.size() != times.size() * width_) {
    throw Error(ErrorCode::invalid_argument,
                "a lookup table has one time and " + std::to_string(width_) + " positions a row");
  }
  const auto is_finite = [](double number) { return std::isfinite(number); };
  const bool rises = std::ranges::adjacent_find(times, std::greater_equal<>()) == times.end();
  if (!rises || !std::ranges::all_of(times, is_finite) ||
      !std::ranges::all_of(positions, is_finite)) {
    throw Error(ErrorCode::invalid_argument,
                "the times of a lookup table rise, and all its numbers are finite");
  }
  const MutexLock lock(loading_);
  Table& table = tables_[loaded_];
  std::ranges::copy(times, table.times.begin());
  std::ranges::copy(positions, table.positions.begin());
  table.size = times.size();
  table.number = ++number_;
  table.at_sample = at_sample;
  loaded_ = middle_.give(loaded_);
  return number_;
}

bool LookupTable::begin_sample(std::uint64_t sample) {
  if (middle_.has_new()) {
    next_ = middle_.take(next_);
    has_next_ = true;
  }
  if (!has_next_ || sample < tables_[next_].at_sample) return false;
  std::swap(active_, next_);
  has_next_ = false;
  current_.store(tables_[active_].number, std::memory_order_release);
  return true;
}

bool LookupTable::read(double time, std::span<double> positions) const {
  const Table& table = tables_[active_];
  if (table.size == 0) return false;
  const double* const begin = table.times.data();
  const auto after =
      static_cast<std::size_t>(std::upper_bound(begin, begin + table.size, time) - begin);
  const std::size_t before = after == 0 ? 0 : after - 1;
  const double* const low = table.positions.data() + before * width_;
  if (after == 0 || after == table.size || interpolation_ == Interpolation::hold) {
    std::copy_n(low, width_, positions.begin());
    return true;
  }
  const double part = (time - begin[before]) / (begin[after] - begin[before]);
  for (std::size_t i = 0; i < width_; ++i) {
    positions[i] = low[i] + part * (low[i + width_] - low[i]);
  }
  return true;
}

double LookupTable::end_time() const {
  const Table& table = tables_[active_];
  return table.size == 0 ? 0 : table.times[table.size - 1];
}

}  // namespace rr::realtime
