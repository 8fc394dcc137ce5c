// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <functional>
#include <memory>

namespace rr::matlab {

/// Ctrl-C while a call waits, and in Octave the signals that end the interpreter (EndingSignals).
/// Both interpreters only set a flag, which somebody has to look at: in Octave a thread does while
/// something waits; in MATLAB the interpreter's own thread must.
class Interrupts {
 public:
  /// `told` is called on a thread of this class, once for each interrupt while something waits.
  explicit Interrupts(std::function<void()> told);
  ~Interrupts();
  Interrupts(const Interrupts&) = delete;
  Interrupts& operator=(const Interrupts&) = delete;

  /// A call begins to wait, and has ended. On the interpreter's thread.
  void begin();
  void end();
  /// Whether the interpreter was interrupted and has not seen it yet. On any thread in Octave, in
  /// MATLAB on the interpreter's.
  [[nodiscard]] static bool is_pending();
  /// Whether is_pending() has to be asked again and again, since nobody is told.
  [[nodiscard]] static bool must_be_asked();

 private:
  struct State;
  std::unique_ptr<State> state_;
};

}  // namespace rr::matlab
