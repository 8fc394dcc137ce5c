// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <functional>
#include <memory>
#include <vector>

#include "rr/realtime/cyclic_loop.hpp"
#include "rr/visibility.hpp"

namespace RR_VISIBLE rr {
namespace realtime {

/// Several loops in one thread on a simulated clock: always the one that is due first, and of those
/// that are due at once in the order in which they were added. The same program so always does the
/// same.
class Lockstep {
 public:
  /// What a loop runs in each cycle.
  using Function = std::function<void(const Cycle&)>;

  /// The clock of all loops. It moves in run_until().
  [[nodiscard]] SimulatedClock& clock() { return clock_; }
  /// A loop of this period, first due one period after now.
  CyclicLoop& add(Nanoseconds period, Function function);
  /// Runs all cycles that are due up to `time`, that one included.
  void run_until(Nanoseconds time);

 private:
  struct Part {
    std::unique_ptr<CyclicLoop> loop;
    Function function;
  };

  SimulatedClock clock_;
  std::vector<Part> parts_;
};

}  // namespace realtime
}  // namespace rr
