// SPDX-License-Identifier: Apache-2.0
#include "runtime/matlab/src/interrupts.hpp"

#include <sys/eventfd.h>
#include <unistd.h>

#include <atomic>
#include <csignal>
#include <cstdint>
#include <thread>
#include <utility>

#ifndef RR_OCTAVE
extern "C" bool utIsInterruptPending();  // libut, of MATLAB
#endif

namespace rr::matlab {
namespace {

// What the handler needs: it can be given nothing else. One node, and so one of these, is in a
// process.
struct Signalled {
  std::atomic<bool> is_pending{false};
  std::atomic<int> descriptor{-1};
  struct sigaction previous {};
};
Signalled signalled;

extern "C" void rr_matlab_interrupted(int signal, siginfo_t* info, void* context) {
  signalled.is_pending = true;
  const std::uint64_t one = 1;
  const int descriptor = signalled.descriptor;
  if (descriptor >= 0 && write(descriptor, &one, sizeof one) < 0) return;  // full: told already
  const struct sigaction& previous = signalled.previous;
  if ((previous.sa_flags & SA_SIGINFO) != 0) {
    previous.sa_sigaction(signal, info, context);
  } else if (previous.sa_handler != SIG_DFL && previous.sa_handler != SIG_IGN) {
    previous.sa_handler(signal);
  }
}

}  // namespace

struct Interrupts::State {
  std::function<void()> told;
  int descriptor = -1;
  std::atomic<bool> is_ending{false};
  std::thread watcher;
};

Interrupts::Interrupts(std::function<void()> told) : state_(std::make_unique<State>()) {
  state_->told = std::move(told);
  if (must_be_asked()) return;
  state_->descriptor = eventfd(0, EFD_CLOEXEC);
  if (state_->descriptor < 0) return;
  signalled.descriptor = state_->descriptor;
  // The interpreter's signals are for its own thread.
  sigset_t all;
  sigset_t before;
  sigfillset(&all);
  pthread_sigmask(SIG_SETMASK, &all, &before);
  state_->watcher = std::thread([state = state_.get()] {
    std::uint64_t count = 0;
    while (read(state->descriptor, &count, sizeof count) > 0 && !state->is_ending) state->told();
  });
  pthread_sigmask(SIG_SETMASK, &before, nullptr);
  struct sigaction ours {};
  sigaction(SIGINT, nullptr, &signalled.previous);
  ours.sa_sigaction = rr_matlab_interrupted;
  ours.sa_mask = signalled.previous.sa_mask;
  ours.sa_flags = signalled.previous.sa_flags | SA_SIGINFO;
  sigaction(SIGINT, &ours, nullptr);
}

Interrupts::~Interrupts() {
  if (state_->descriptor < 0) return;
  struct sigaction now {};
  sigaction(SIGINT, nullptr, &now);
  const bool is_ours = (now.sa_flags & SA_SIGINFO) != 0 &&
                       now.sa_sigaction == rr_matlab_interrupted;  // else somebody builds on it
  if (is_ours) sigaction(SIGINT, &signalled.previous, nullptr);
  signalled.descriptor = -1;
  state_->is_ending = true;
  const std::uint64_t one = 1;
  if (write(state_->descriptor, &one, sizeof one) == sizeof one) state_->watcher.join();
  close(state_->descriptor);
}

void Interrupts::begin() { signalled.is_pending = false; }

bool Interrupts::is_pending() const {
#ifdef RR_OCTAVE
  return signalled.is_pending;
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
