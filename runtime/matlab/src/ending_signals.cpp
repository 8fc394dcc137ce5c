// SPDX-License-Identifier: Apache-2.0
#include "runtime/matlab/src/ending_signals.hpp"

// Windows has no such signals: the console's events are the interpreter's.
#if defined(RR_OCTAVE) && !defined(_WIN32)
#define RR_HAS_SIGNALS
#endif

#ifdef RR_HAS_SIGNALS
#include <octave/quit.h>
#include <signal.h>

#include <array>
#include <atomic>

#include "rr/matlab/containers.hpp"
#endif

namespace rr::matlab {

#ifdef RR_HAS_SIGNALS
namespace {

struct Chained {
  const int number;
  const char* const dump;  ///< the interpreter's function that says whether a workspace is written
  struct sigaction before {};
};

// A handler has nothing but what is static.
std::array<Chained, 2> chained{
    {{SIGTERM, "sigterm_dumps_octave_core"}, {SIGHUP, "sighup_dumps_octave_core"}}};
sigset_t taken;        // of these, those with a handler of the interpreter's
sigset_t mask_before;  // of its thread
std::atomic<bool> has_come{false};
static_assert(std::atomic<bool>::is_always_lock_free);

void note(int number, siginfo_t* details, void* context) {
  has_come = true;
  for (const Chained& one : chained) {
    if (one.number != number) continue;
    if ((one.before.sa_flags & SA_SIGINFO) != 0) {
      one.before.sa_sigaction(number, details, context);
    } else {
      one.before.sa_handler(number);
    }
  }
}

bool has_handler(const struct sigaction& action) {
  return (action.sa_flags & SA_SIGINFO) != 0 ||
         (action.sa_handler != SIG_DFL && action.sa_handler != SIG_IGN);
}

}  // namespace

EndingSignals::EndingSignals() {
  has_come = false;
  sigemptyset(&taken);
  for (Chained& one : chained) {
    // Without a handler the process ends at once, or is not to end.
    if (sigaction(one.number, nullptr, &one.before) != 0 || !has_handler(one.before)) continue;
    call_function(one.dump, {mxCreateLogicalScalar(false)});
    struct sigaction ours = one.before;
    ours.sa_sigaction = note;
    ours.sa_flags |= SA_SIGINFO;
    if (sigaction(one.number, &ours, nullptr) == 0) sigaddset(&taken, one.number);
  }
  pthread_sigmask(SIG_SETMASK, nullptr, &mask_before);
}

EndingSignals::~EndingSignals() {
  for (const Chained& one : chained) {
    if (sigismember(&taken, one.number) != 1) continue;
    if (sigismember(&mask_before, one.number) != 1) sigdelset(&taken, one.number);
    struct sigaction now {};
    // Somebody else may have come before this one, and calls it: then it stays.
    if (sigaction(one.number, nullptr, &now) == 0 && (now.sa_flags & SA_SIGINFO) != 0 &&
        now.sa_sigaction == note) {
      sigaction(one.number, &one.before, nullptr);
    }
  }
  pthread_sigmask(SIG_BLOCK, &taken, nullptr);
}

void EndingSignals::prepare() {
  pthread_sigmask(SIG_UNBLOCK, &taken, nullptr);
  has_come = false;
  // What came to the other thread, or before; Ctrl-C is for the call to see.
  if (octave_signal_caught == 0 || octave_interrupt_state != 0) return;
  try {
    octave_quit();
  } catch (const octave::interrupt_exception&) {
    // Octave notes that a signal has come before it counts Ctrl-C. As its handler leaves it:
    octave_interrupt_state = 1;
    octave_signal_caught = 1;
  }
}

bool EndingSignals::is_pending() { return has_come && octave_signal_caught != 0; }

void EndingSignals::end_interpreter() {
  if (is_pending()) octave_quit();
}

#else

EndingSignals::EndingSignals() = default;
EndingSignals::~EndingSignals() = default;
bool EndingSignals::is_pending() { return false; }
void EndingSignals::prepare() {}
void EndingSignals::end_interpreter() {}

#endif

}  // namespace rr::matlab
