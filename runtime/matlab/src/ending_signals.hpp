// SPDX-License-Identifier: Apache-2.0
#pragma once

namespace rr::matlab {

/// SIGTERM and SIGHUP on their way to Octave, which notes them and ends itself between two
/// statements, and so not while a call waits. Its handlers are called in any case; this one only
/// says that they were. Nothing in MATLAB, which handles signals on threads of its own, and on
/// Windows.
class EndingSignals {
 public:
  /// Puts a handler before the interpreter's; the end takes it away again. Octave writes no
  /// workspace at these signals any more: it cannot save objects, and would go on where it fails
  /// to. One at a time, on the interpreter's thread.
  EndingSignals();
  ~EndingSignals();
  EndingSignals(const EndingSignals&) = delete;
  EndingSignals& operator=(const EndingSignals&) = delete;

  /// Before this thread waits: has it take the signals, which in Octave another one does that tells
  /// nobody, and ends the interpreter if one has come before. Again after functions of the user's,
  /// which may have changed who takes them. On the interpreter's thread.
  static void prepare();
  /// Whether one has come and the interpreter has not seen it yet. On any thread.
  [[nodiscard]] static bool is_pending();
  /// Ends the interpreter if one is pending, by an exception of the interpreter's own: where an
  /// error is caught it forgets what is pending. On the interpreter's thread.
  static void end_interpreter();
};

}  // namespace rr::matlab
