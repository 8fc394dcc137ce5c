// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <functional>
#include <memory>

namespace rr::matlab {

/// Ctrl-C, while a call waits. In Octave it is a signal, which goes on to Octave's own handler; in
/// MATLAB the interpreter has to be asked.
class Interrupts {
 public:
  /// `told` is called on a thread of this class, after each signal.
  explicit Interrupts(std::function<void()> told);
  ~Interrupts();
  Interrupts(const Interrupts&) = delete;
  Interrupts& operator=(const Interrupts&) = delete;

  /// Forgets what was before: a call begins to wait.
  void begin();
  /// Whether there was an interrupt since. On the interpreter's thread.
  [[nodiscard]] bool is_pending() const;
  /// Whether is_pending() has to be asked again and again, since nobody is told.
  [[nodiscard]] static bool must_be_asked();

 private:
  struct State;
  std::unique_ptr<State> state_;
};

}  // namespace rr::matlab
