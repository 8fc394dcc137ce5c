// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <cstdint>

namespace rr::sim {

/// The numbers of a run: the same for the same seed, on every machine.
class Random {
 public:
  explicit Random(std::uint64_t seed) : state_(seed) {}

  std::uint64_t next() {
    state_ += 0x9e3779b97f4a7c15U;
    std::uint64_t mixed = state_;
    mixed = (mixed ^ (mixed >> 30U)) * 0xbf58476d1ce4e5b9U;
    mixed = (mixed ^ (mixed >> 27U)) * 0x94d049bb133111ebU;
    return mixed ^ (mixed >> 31U);
  }
  /// Below `end`, which is not 0.
  std::uint64_t below(std::uint64_t end) { return next() % end; }
  /// True once in `times`; never for 0.
  bool once_in(std::uint64_t times) { return times != 0 && next() % times == 0; }

 private:
  std::uint64_t state_;
};

}  // namespace rr::sim
