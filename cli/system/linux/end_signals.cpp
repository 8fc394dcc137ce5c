// SPDX-License-Identifier: Apache-2.0
#include "cli/system/end_signals.hpp"

#include <pthread.h>
#include <signal.h>

#include <ctime>

namespace robdef {

struct EndSignals::State {
  [[nodiscard]] bool wait(const timespec& limit) const {
    return sigtimedwait(&signals, nullptr, &limit) > 0;
  }

  sigset_t signals{};
  sigset_t before{};
};

EndSignals::EndSignals() : state_(std::make_unique<State>()) {
  sigemptyset(&state_->signals);
  sigaddset(&state_->signals, SIGINT);
  sigaddset(&state_->signals, SIGTERM);
  pthread_sigmask(SIG_BLOCK, &state_->signals, &state_->before);
}

EndSignals::~EndSignals() { pthread_sigmask(SIG_SETMASK, &state_->before, nullptr); }

bool EndSignals::wait() const { return state_->wait(timespec{1, 0}); }
bool EndSignals::has_come() const { return state_->wait(timespec{0, 0}); }

struct EndSignals::Allowed::Before {
  sigset_t mask{};
};

EndSignals::Allowed::Allowed(const EndSignals& signals) : before_(std::make_unique<Before>()) {
  pthread_sigmask(SIG_UNBLOCK, &signals.state_->signals, &before_->mask);
}

EndSignals::Allowed::~Allowed() { pthread_sigmask(SIG_SETMASK, &before_->mask, nullptr); }

}  // namespace robdef
