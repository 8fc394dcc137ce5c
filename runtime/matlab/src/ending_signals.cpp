// SPDX-License-Identifier: Apache-2.0
#include "runtime/matlab/src/ending_signals.hpp"

#ifdef RR_OCTAVE
#include <octave/quit.h>
#include <signal.h>

#include <array>
#include <atomic>
#include <utility>

#include "rr/matlab/containers.hpp"
#endif

namespace rr::matlab {

#ifdef RR_OCTAVE
namespace {

struct Chained {
  const int number;
  const char* const dump;  ///< the interpreter's function that says whether a workspace is written
  struct sigaction before {};
  bool is_ours = false;
};

// A handler has nothing but what is static.
std::array<Chained, 2> chained{
    {{SIGTERM, "sigterm_dumps_octave_core"}, {SIGHUP, "sighup_dumps_octave_core"}}};
sigset_t blocked_before;
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
  sigset_t all;
  sigemptyset(&all);
  for (Chained& one : chained) {
    // Without a handler the process ends at once, or is not to end.
    if (sigaction(one.number, nullptr, &one.before) != 0 || !has_handler(one.before)) continue;
    call_function(one.dump, {mxCreateLogicalScalar(false)});
    struct sigaction ours = one.before;
    ours.sa_sigaction = note;
    ours.sa_flags |= SA_SIGINFO;
    one.is_ours = sigaction(one.number, &ours, nullptr) == 0;
    if (one.is_ours) sigaddset(&all, one.number);
  }
  pthread_sigmask(SIG_UNBLOCK, &all, &blocked_before);
}

EndingSignals::~EndingSignals() {
  sigset_t all;
  sigemptyset(&all);
  for (Chained& one : chained) {
    if (!std::exchange(one.is_ours, false)) continue;
    if (sigismember(&blocked_before, one.number) == 1) sigaddset(&all, one.number);
    struct sigaction now {};
    // Somebody else may have come before this one, and calls it: then it stays.
    if (sigaction(one.number, nullptr, &now) == 0 && (now.sa_flags & SA_SIGINFO) != 0 &&
        now.sa_sigaction == note) {
      sigaction(one.number, &one.before, nullptr);
    }
  }
  pthread_sigmask(SIG_BLOCK, &all, nullptr);
}

bool EndingSignals::is_pending() { return has_come && octave_signal_caught != 0; }

void EndingSignals::end_interpreter() {
  if (is_pending()) octave_quit();
}

void EndingSignals::forget_seen() {
  if (has_come && octave_signal_caught == 0) has_come = false;
}

#else

EndingSignals::EndingSignals() = default;
EndingSignals::~EndingSignals() = default;
bool EndingSignals::is_pending() { return false; }
void EndingSignals::end_interpreter() {}
void EndingSignals::forget_seen() {}

#endif

}  // namespace rr::matlab
