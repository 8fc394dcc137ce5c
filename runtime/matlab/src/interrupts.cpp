// SPDX-License-Identifier: Apache-2.0
#include "runtime/matlab/src/interrupts.hpp"

#include <atomic>
#include <chrono>
#include <thread>
#include <utility>

#include "rr/mutex.hpp"
#include "runtime/matlab/src/ending_signals.hpp"

#ifndef _WIN32
#include <signal.h>
#endif
#ifdef RR_OCTAVE
#include <octave/quit.h>
#else
extern "C" bool utIsInterruptPending();  // libut, of MATLAB
#endif

namespace rr::matlab {
namespace {

constexpr std::chrono::milliseconds period{50};  // of looking
constexpr int idle_periods = 20;                 // without a call before the thread sleeps

/// Signals are for the interpreter's own threads; Windows has none.
std::thread thread_without_signals(std::function<void()> work) {
#ifdef _WIN32
  return std::thread(std::move(work));
#else
  sigset_t all;
  sigset_t before;
  sigfillset(&all);
  pthread_sigmask(SIG_SETMASK, &all, &before);
  std::thread made(std::move(work));
  pthread_sigmask(SIG_SETMASK, &before, nullptr);
  return made;
#endif
}

}  // namespace

struct Interrupts::State {
  void look();

  std::function<void()> told;
  std::atomic<bool> is_waiting{false};
  std::atomic<bool> is_asleep{false};
  Mutex mutex;
  Condition changed;
  bool is_ending RR_GUARDED_BY(mutex) = false;
  std::thread watcher;
  EndingSignals ending;
};

void Interrupts::State::look() {
  int idle = 0;
  bool was_told = false;
  MutexLock lock(mutex);
  while (!is_ending) {
    idle = is_waiting ? 0 : idle + 1;
    if (idle < idle_periods) {
      changed.wait_until(mutex, std::chrono::steady_clock::now() + period);
    } else {
      // A call that begins now sees that this sleeps, or is seen.
      is_asleep = true;
      while (!is_ending && !is_waiting) changed.wait(mutex);
      is_asleep = false;
      idle = 0;
    }
    const bool is_interrupted = is_waiting && is_pending();
    if (is_interrupted && !was_told) {
      lock.unlock();
      told();
      lock.lock();
    }
    was_told = is_interrupted;
  }
}

Interrupts::Interrupts(std::function<void()> told) : state_(std::make_unique<State>()) {
  state_->told = std::move(told);
  if (must_be_asked()) return;
  state_->watcher = thread_without_signals([state = state_.get()] { state->look(); });
}

Interrupts::~Interrupts() {
  if (!state_->watcher.joinable()) return;
  {
    const MutexLock lock(state_->mutex);
    state_->is_ending = true;
  }
  state_->changed.notify_one();
  state_->watcher.join();
}

void Interrupts::begin() {
  state_->is_waiting = true;
  if (!state_->is_asleep) return;
  const MutexLock lock(state_->mutex);
  state_->changed.notify_one();
}

void Interrupts::end() { state_->is_waiting = false; }

bool Interrupts::is_pending() {
#ifdef RR_OCTAVE
  return octave_interrupt_state > 0 || EndingSignals::is_pending();
#else
  return utIsInterruptPending();
#endif
}

bool Interrupts::must_be_asked() {
#ifdef RR_OCTAVE
  return false;
#else
  return true;
#endif
}

}  // namespace rr::matlab
