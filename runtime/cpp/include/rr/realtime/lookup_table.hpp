// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <array>
#include <atomic>
#include <cstddef>
#include <cstdint>
#include <span>
#include <vector>

#include "rr/mutex.hpp"
#include "rr/realtime/exchange.hpp"
#include "rr/visibility.hpp"

namespace RR_VISIBLE rr {
namespace realtime {

/// Positions at sampled times, which a loop follows, and which are replaced while it runs: in one
/// step, at a chosen sample. There is the old table or the new one, never a mixture.
class LookupTable {
 public:
  /// Between two rows.
  enum class Interpolation {
    hold,    ///< the row before
    linear,  ///< on the straight line
  };

  /// A table for up to `capacity` rows of `width` positions each. It is empty at first. Throws
  /// rr::Error (invalid_argument) when one of them is 0.
  LookupTable(std::size_t width, std::size_t capacity,
              Interpolation interpolation = Interpolation::linear);
  ~LookupTable();
  LookupTable(const LookupTable&) = delete;
  LookupTable& operator=(const LookupTable&) = delete;

  /// Positions of a row.
  [[nodiscard]] std::size_t width() const { return width_; }
  /// The most rows that a table may have.
  [[nodiscard]] std::size_t capacity() const { return capacity_; }

  /// Has the loop follow a new table from its sample `at_sample` on, or from its next one when that
  /// has passed. `times` rise; `positions` are as many rows of `width`. A table that waits to
  /// become the loop's is replaced. Returns the new table's number, from 1 on. By any thread but
  /// the loop's. Throws rr::Error: invalid_argument for numbers that do not fit, times that do not
  /// rise or numbers that are not finite, out_of_range for more rows than the capacity; the loop's
  /// table stays then.
  std::uint64_t load(std::span<const double> times, std::span<const double> positions,
                     std::uint64_t at_sample = 0);
  /// Number of the table that the loop follows; 0 for none. By any thread.
  [[nodiscard]] std::uint64_t current() const { return current_.load(std::memory_order_acquire); }

  /// The loop's, once at each of its samples: changes to a table that has been loaded for this one.
  /// True when it did. Does not allocate, lock or call the kernel, and ends in a bounded time.
  bool begin_sample(std::uint64_t sample);
  /// The loop's: the positions at `time`, in the unit of the table; before the first row that row,
  /// after the last one that. False, with nothing written, when there is no table. `positions` has
  /// `width` numbers.
  bool read(double time, std::span<double> positions) const;
  /// The loop's: time of the last row; 0 when there is no table.
  [[nodiscard]] double end_time() const;

 private:
  struct Table;

  std::size_t width_;
  std::size_t capacity_;
  Interpolation interpolation_;
  // Four places: the loop's table, the one it is to change to, one on its way, and the loader's.
  std::vector<Table> tables_;
  PlaceExchange<> middle_{2};
  std::atomic<std::uint64_t> current_{0};
  std::uint8_t active_ = 0;  // the loop's
  std::uint8_t next_ = 1;    // the loop's
  bool has_next_ = false;
  Mutex loading_;  // of those who load
  std::uint8_t loaded_ RR_GUARDED_BY(loading_) = 3;
  std::uint64_t number_ RR_GUARDED_BY(loading_) = 0;
};

}  // namespace realtime
}  // namespace rr
