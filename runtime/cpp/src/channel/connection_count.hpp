// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <cstddef>

#include "rr/mutex.hpp"

namespace rr::channel {

/// How many connections of a node there are, for whoever ends it.
///
/// A connection counts from when it has a receiver until it has notified that one of its end. Any
/// thread may call.
class ConnectionCount {
 public:
  void begin() {
    const MutexLock lock(mutex_);
    ++count_;
  }
  /// One that has begun.
  void end() {
    const MutexLock lock(mutex_);
    if (--count_ == 0) none_.notify_all();
  }
  /// Waits until there is none.
  void wait_for_none() {
    const MutexLock lock(mutex_);
    while (count_ != 0) none_.wait(mutex_);
  }

 private:
  Mutex mutex_;
  Condition none_;
  std::size_t count_ RR_GUARDED_BY(mutex_) = 0;
};

}  // namespace rr::channel
