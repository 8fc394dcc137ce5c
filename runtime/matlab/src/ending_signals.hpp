// SPDX-License-Identifier: Apache-2.0
#pragma once

namespace rr::matlab {

/// SIGTERM and SIGHUP on their way to Octave, which notes them and ends itself between two
/// statements, and so not while a call waits. Its handlers are called in any case; this one only
/// says that they were. Nothing in MATLAB, which handles signals on threads of its own.
class EndingSignals {
 public:
  /// Puts a handler before the interpreter's, and has this thread take the signals, which in Octave
  /// another one does that nobody can ask; the end undoes it. Octave writes no workspace at these
  /// signals any more: it cannot save objects, and would go on where it fails to. One at a time,
  /// on the interpreter's thread.
  EndingSignals();
  ~EndingSignals();
  EndingSignals(const EndingSignals&) = delete;
  EndingSignals& operator=(const EndingSignals&) = delete;

  /// Whether one has come and the interpreter has not seen it yet. On any thread.
  [[nodiscard]] static bool is_pending();
  /// Ends the interpreter if one is pending, by an exception of the interpreter's own: where an
  /// error is caught it forgets what is pending. On the interpreter's thread.
  static void end_interpreter();
  /// Forgets one that the interpreter has seen, as in a function that it calls at its end. On the
  /// interpreter's thread.
  static void forget_seen();
};

}  // namespace rr::matlab
