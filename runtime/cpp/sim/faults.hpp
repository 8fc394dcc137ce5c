// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <cstddef>
#include <cstdint>

#include "runtime/cpp/sim/scheduler.hpp"

namespace rr::sim {

/// The faults of a run, drawn from its seed. A number N means once in N times; 0: never.
struct Faults {
  std::uint64_t spurious_wake_ups = 0;  ///< of conditions
  std::uint64_t refused_threads = 0;
  std::uint64_t refused_memory = 0;  ///< requests of more than `small_block` bytes
  // Of the network
  Nanoseconds longest_delay = 1'000'000;  ///< of a segment
  std::uint64_t split_segments = 0;       ///< what is sent at once arrives in parts
  std::size_t smallest_window = 4096;     ///< bytes under way in one direction of a connection
  std::size_t largest_window = 262'144;
  std::uint64_t lost_datagrams = 0;
  std::uint64_t doubled_datagrams = 0;

  /// Those of the run; none outside of one.
  static Faults& current();

  /// When a waiting thread is woken for no reason; `never` mostly.
  [[nodiscard]] Nanoseconds next_spurious_wake_up(Scheduler& run) const;
  [[nodiscard]] bool refuses_thread(Scheduler& run) const;
  [[nodiscard]] bool refuses_memory(Scheduler& run, std::size_t size) const;

  /// The calling thread is the scenario's: it gets what it asks for.
  static void spare_this_thread();
};

/// The calling thread gets all memory that it asks for while this exists: what a run itself needs.
class Spared {
 public:
  Spared() { ++depth_; }
  ~Spared() { --depth_; }
  Spared(const Spared&) = delete;
  Spared& operator=(const Spared&) = delete;
  static bool is_in_effect() { return depth_ != 0; }

 private:
  static inline thread_local constinit int depth_ = 0;
};

}  // namespace rr::sim
