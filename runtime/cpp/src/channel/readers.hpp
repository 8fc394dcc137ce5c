// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <atomic>

#include "runtime/cpp/src/channel/time.hpp"

namespace rr::channel {

/// Whether several connections of a node are read these days. One alone may receive much at once;
/// beside others it receives less, so that they do not wait for it. Any thread.
class Readers {
 public:
  /// `reader` has received something. Only who reads after another one writes here.
  void note(const void* reader, Time now) {
    if (last_.load(std::memory_order_relaxed) == reader) return;
    last_.store(reader, std::memory_order_relaxed);
    changed_.store(now, std::memory_order_relaxed);
  }
  /// True while one has received after another within a short time.
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
