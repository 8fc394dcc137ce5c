// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <array>
#include <cstdint>

#include "experimental/microassembly.hpp"
#include "rr/realtime/cyclic_loop.hpp"
#include "rr/realtime/lookup_table.hpp"
#include "rr/realtime/signals.hpp"
#include "rr/realtime/state_bus.hpp"

namespace microassembly {

namespace wire = experimental::microassembly;

inline constexpr std::size_t axis_count = 15;

/// Half of the part's width, in micrometres.
inline constexpr double part_size = 60;

/// The one real-time node: 15 simulated axes, and a part that goes with the stage until both probes
/// press on it and carry it away. A cycle is a millisecond.
class Node {
 public:
  /// One cycle: what the loop calls. Allocates nothing.
  void step(const rr::realtime::Cycle& cycle);

  rr::realtime::LookupTable& table() { return table_; }
  rr::realtime::CommandGroup<wire::AxesTarget>& target() { return target_; }
  [[nodiscard]] const rr::realtime::SignalGroup<wire::AxesState>& state() const { return state_; }

 private:
  void move_axes();
  void move_part();

  rr::realtime::LookupTable table_{axis_count, 1000};
  rr::realtime::CommandGroup<wire::AxesTarget> target_;
  rr::realtime::SignalGroup<wire::AxesState> state_;
  std::array<double, axis_count> wanted_{};
  std::array<double, axis_count> exact_{};  // of steppers before they are rounded to steps
  std::uint64_t table_begin_ = 0;
  bool is_on_table_ = false;
  wire::AxesState now_{};
};

/// Where a probe's tip is: 0 the left one, 1 the right one; x, y, z in micrometres on the table.
std::array<double, 3> tip(const wire::AxesState& state, std::size_t probe);

}  // namespace microassembly
