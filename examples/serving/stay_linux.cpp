// SPDX-License-Identifier: Apache-2.0
#include <pthread.h>
#include <signal.h>

#include <algorithm>
#include <ctime>

#include "examples/serving/serving.hpp"

namespace serving {

using std::chrono::steady_clock;

struct Stay::Signals {
  sigset_t set{};
};

Stay::Stay(int seconds)
    : signals_(new Signals),
      has_limit_(seconds > 0),
      end_(steady_clock::now() + std::chrono::seconds(seconds)) {
  sigemptyset(&signals_->set);
  sigaddset(&signals_->set, SIGINT);
  sigaddset(&signals_->set, SIGTERM);
  pthread_sigmask(SIG_BLOCK, &signals_->set, nullptr);
}

Stay::~Stay() = default;

bool Stay::wait(std::chrono::milliseconds time) {
  if (is_over_) return false;
  auto until = steady_clock::now() + time;
  if (has_limit_) until = std::min(until, end_);
  const auto left = std::max(until - steady_clock::now(), steady_clock::duration::zero());
  const auto seconds = std::chrono::floor<std::chrono::seconds>(left);
  const timespec limit{static_cast<std::time_t>(seconds.count()),
                       static_cast<long>(std::chrono::nanoseconds(left - seconds).count())};
  // What comes of it otherwise, a handled signal of another kind, only makes this wait shorter.
  is_over_ = sigtimedwait(&signals_->set, nullptr, &limit) > 0 ||
             (has_limit_ && steady_clock::now() >= end_);
  return !is_over_;
}

}  // namespace serving
