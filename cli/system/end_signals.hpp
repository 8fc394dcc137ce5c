// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <memory>

namespace robdef {

/// What asks the program to end (SIGINT and SIGTERM; on Windows Ctrl-C and the like) is taken by
/// the thread that waits for it here, while this lives. To be made before any thread is.
class EndSignals {
 public:
  EndSignals();
  ~EndSignals();
  EndSignals(const EndSignals&) = delete;
  EndSignals& operator=(const EndSignals&) = delete;

  /// True when one came within a second.
  [[nodiscard]] bool wait() const;
  /// True when one has come.
  [[nodiscard]] bool has_come() const;

  /// While this lives they do to the calling thread what they always do.
  class Allowed {
   public:
    explicit Allowed(const EndSignals& signals);
    ~Allowed();
    Allowed(const Allowed&) = delete;
    Allowed& operator=(const Allowed&) = delete;

   private:
    struct Before;
    const std::unique_ptr<Before> before_;
  };

 private:
  struct State;
  const std::unique_ptr<State> state_;
};

}  // namespace robdef
