// SPDX-License-Identifier: Apache-2.0
#pragma once

#include "rr/visibility.hpp"

namespace rr::platform {

/// While this lives, what asks the program to end (SIGTERM and SIGINT; on Windows Ctrl-C and the
/// like) ends wait() instead, on whichever thread it comes. What was done for it before is done
/// again afterwards. One at a time in the process.
class RR_INSIDE EndSignals {
 public:
  /// `is_taken` becomes false when there is another one: then wait() may not be called.
  explicit EndSignals(bool& is_taken);
  ~EndSignals();
  EndSignals(const EndSignals&) = delete;
  EndSignals& operator=(const EndSignals&) = delete;

  /// Waits for a signal, whose number it returns, or for interrupt(): 0.
  int wait();
  /// Any thread; also before wait().
  void interrupt();

 private:
  bool is_taken_ = false;
};

}  // namespace rr::platform
