// SPDX-License-Identifier: Apache-2.0
#pragma once

#include "rr/mutex.hpp"
#include "rr/node.hpp"
#include "runtime/cpp/src/platform/end_signals.hpp"

namespace rr {

/// Waits for what ends a service, and keeps the service manager informed meanwhile.
class EndOfService {
 public:
  /// Returns the signal that came, 0 for request(). Throws rr::Error (invalid_operation) while
  /// somebody else in the process waits.
  int wait(Node& node);
  /// Ends wait(), also one that has not begun. Any thread.
  void request();

 private:
  void set_signals(platform::EndSignals* signals);

  Mutex mutex_;
  bool is_requested_ RR_GUARDED_BY(mutex_) = false;
  platform::EndSignals* signals_ RR_GUARDED_BY(mutex_) = nullptr;  // of the thread that waits
};

}  // namespace rr
