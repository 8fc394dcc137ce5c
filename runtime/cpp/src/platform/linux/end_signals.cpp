// SPDX-License-Identifier: Apache-2.0
#include "runtime/cpp/src/platform/end_signals.hpp"

#include <pthread.h>
#include <semaphore.h>
#include <signal.h>

#include <array>
#include <atomic>
#include <cerrno>

namespace rr::platform {
namespace {

constexpr std::array<int, 2> end_signals{SIGTERM, SIGINT};

std::atomic<bool> is_somebody_waiting{false};
// What a handler of signals may touch.
std::atomic<int> came{0};
sem_t bell;
// What was done for the signals before, and which of them the waiting thread had blocked.
std::array<struct sigaction, 2> actions_before;
sigset_t blocked_before;

extern "C" void rr_on_end_signal(int signal) {
  const int kept = errno;
  came.store(signal);
  sem_post(&bell);
  errno = kept;
}

}  // namespace

// A handler, and not a set of blocked signals: threads that were there before take signals, too.
EndSignals::EndSignals(bool& is_taken) {
  is_taken = is_taken_ = !is_somebody_waiting.exchange(true);
  if (!is_taken_) return;
  came = 0;
  sem_init(&bell, 0, 0);
  struct sigaction action {};
  action.sa_handler = &rr_on_end_signal;
  sigemptyset(&action.sa_mask);
  action.sa_flags = SA_RESTART;
  sigset_t wanted;
  sigemptyset(&wanted);
  for (std::size_t i = 0; i != end_signals.size(); ++i) {
    sigaction(end_signals.at(i), &action, &actions_before.at(i));
    sigaddset(&wanted, end_signals.at(i));
  }
  // Programs that have blocked them on all threads would never see one.
  pthread_sigmask(SIG_UNBLOCK, &wanted, &blocked_before);
}

EndSignals::~EndSignals() {
  if (!is_taken_) return;
  pthread_sigmask(SIG_SETMASK, &blocked_before, nullptr);
  for (std::size_t i = 0; i != end_signals.size(); ++i) {
    sigaction(end_signals.at(i), &actions_before.at(i), nullptr);
  }
  sem_destroy(&bell);
  is_somebody_waiting = false;
}

int EndSignals::wait() {
  while (sem_wait(&bell) != 0 && errno == EINTR) {
  }
  return came.load();
}

void EndSignals::interrupt() { sem_post(&bell); }

}  // namespace rr::platform
