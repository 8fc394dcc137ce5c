// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <atomic>

#include "runtime/cpp/src/channel/time.hpp"

namespace rr::channel {

/// Whether several connections of a node receive data at the same time. A single connection may
/// receive much at once; beside others it receives less, so that it does not block them.
/// Thread-safe. On a cache line of its own, since threads of different connections write it.
class alignas(64) Readers {
 public:
  /// Records that the connection `reader` has received data. Writes nothing if it was also the last
  /// one to receive.
  void note(const void* reader, Time now) {
    if (last_.load(std::memory_order_relaxed) == reader) return;
    last_.store(reader, std::memory_order_relaxed);
    changed_.store(now, std::memory_order_relaxed);
  }
  /// True if two connections received one after the other within `memory`.
  [[nodiscard]] bool are_several(Time now) const {
    const Time changed = changed_.load(std::memory_order_relaxed);
    return changed != Time::min() && now - changed < memory;
  }

  static constexpr Milliseconds memory{100};

 private:
  std::atomic<const void*> last_{nullptr};
  std::atomic<Time> changed_{Time::min()};
};

}  // namespace rr::channel
