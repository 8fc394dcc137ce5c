// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <cstddef>
#include <cstdint>
#include <functional>
#include <memory>
#include <thread>
#include <utility>
#include <vector>

#include "rr/memories.hpp"
#include "rr/mutex.hpp"
#include "rr/realtime/cyclic_loop.hpp"
#include "rr/realtime/layout.hpp"
#include "rr/realtime/lookup_table.hpp"
#include "rr/realtime/signals.hpp"
#include "rr/realtime/state_bus.hpp"
#include "rr/type_of.hpp"
#include "rr/visibility.hpp"
#include "rr/wires.hpp"

/// A loop's bus as members of an object: wires for its signals, a memory for its lookup table. None
/// of this runs in the loop's thread, and nothing that clients do makes the loop wait.
namespace RR_VISIBLE rr {
namespace realtime {

/// The layout of a pod as its description has it. Throws rr::Error (invalid_argument) for what is
/// no pod, and for what has no fixed place (`double[6-]`).
Layout layout_of(const Type& type);
/// The layout of a pod of generated code.
template <Pod T>
Layout layout_of() {
  return layout_of(type_of<T>);
}

/// Carries signals between a loop and the wires of an object, in a thread of its own. Made and
/// ended by one thread; what it was given lives longer.
class BusService {
 public:
  /// Looks at the loop's signals once each period.
  explicit BusService(Nanoseconds period);
  /// Waits for what it is doing.
  ~BusService();
  BusService(const BusService&) = delete;
  BusService& operator=(const BusService&) = delete;

  /// Each client of the wire gets the group when it has changed; who peeks gets a snapshot of the
  /// moment, also when this has ended, so the group lives longer than the object. Throws rr::Error
  /// (write_only_member) for a wire that sends nothing.
  template <Pod T>
  void publish(const SignalGroup<T>& group, const WireServer<T>& wire) {
    wire.set_in(group.read());
    wire.on_peek_in([&group] { return group.read(); });
    add([&group, wire, seen = std::uint64_t{0}]() mutable {
      const std::uint64_t version = group.version();
      if (version == seen) return;
      seen = version;
      wire.set_in(group.read());
    });
  }
  /// What clients send or poke becomes the group's value, the newest of all. The group lives longer
  /// than the object.
  template <Pod T>
  static void accept(const WireServer<T>& wire, CommandGroup<T>& group) {
    wire.on_peek_out([&group] { return group.newest(); });
    wire.on_out([&group](const T& value, const TimeSpec&, std::uint32_t) { group.set(value); });
  }

 private:
  void add(std::function<void()> task);
  void run();

  const Nanoseconds period_;
  Mutex mutex_;
  Condition changed_;
  bool is_over_ RR_GUARDED_BY(mutex_) = false;
  std::vector<std::function<void()>> new_tasks_ RR_GUARDED_BY(mutex_);
  std::thread thread_;
};

/// The memory that a lookup table is written to: rows of a time and its positions, one after the
/// other. The loop sees nothing of it until load().
class TableMemory final : public StoredArrayMemory<double> {
 public:
  /// The table lives longer.
  explicit TableMemory(LookupTable& table)
      : StoredArrayMemory<double>(table.capacity() * (table.width() + 1)), table_(table) {}

  /// Has the loop change to the first so many rows, at its sample `at_sample` or its next one.
  /// Returns the table's number. Throws rr::Error as LookupTable::load.
  std::uint64_t load(std::size_t rows, std::uint64_t at_sample = 0);

 private:
  LookupTable& table_;
};

}  // namespace realtime
}  // namespace rr
