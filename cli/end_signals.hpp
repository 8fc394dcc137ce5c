// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <pthread.h>
#include <signal.h>

#include <ctime>

namespace robdef {

/// The signals that ask the program to end are taken by whoever waits for them here, while this
/// lives. To be made before any thread is.
class EndSignals {
 public:
  EndSignals() {
    sigemptyset(&signals_);
    sigaddset(&signals_, SIGINT);
    sigaddset(&signals_, SIGTERM);
    pthread_sigmask(SIG_BLOCK, &signals_, &before_);
  }
  ~EndSignals() { pthread_sigmask(SIG_SETMASK, &before_, nullptr); }
  EndSignals(const EndSignals&) = delete;
  EndSignals& operator=(const EndSignals&) = delete;

  /// True when one came within a second.
  [[nodiscard]] bool wait() const { return wait(timespec{1, 0}); }
  /// True when one has come.
  [[nodiscard]] bool has_come() const { return wait(timespec{0, 0}); }

  /// While this lives they do to the calling thread what they always do.
  class Allowed {
   public:
    explicit Allowed(const EndSignals& signals) {
      pthread_sigmask(SIG_UNBLOCK, &signals.signals_, &before_);
    }
    ~Allowed() { pthread_sigmask(SIG_SETMASK, &before_, nullptr); }
    Allowed(const Allowed&) = delete;
    Allowed& operator=(const Allowed&) = delete;

   private:
    sigset_t before_{};
  };

 private:
  [[nodiscard]] bool wait(const timespec& limit) const {
    return sigtimedwait(&signals_, nullptr, &limit) > 0;
  }

  sigset_t signals_{};
  sigset_t before_{};
};

}  // namespace robdef
