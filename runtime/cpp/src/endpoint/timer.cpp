// SPDX-License-Identifier: Apache-2.0
#include "runtime/cpp/src/endpoint/timer.hpp"

#include <algorithm>
#include <string>
#include <utility>

#include "runtime/cpp/src/endpoint/user_code.hpp"

namespace rr {

using std::chrono::nanoseconds;

Timer::State::State(std::shared_ptr<channel::Reactor> reactor, Terms terms)
    : reactor_(std::move(reactor)),
      period_(std::min<nanoseconds>(terms.period, channel::longest_span)),
      report_(std::move(terms.report)),
      work_(std::move(terms.work)),
      due_(channel::Clock::now() +
           std::clamp<nanoseconds>(terms.delay, nanoseconds(0), channel::longest_span)) {}

void Timer::State::start() {
  const MutexLock lock(mutex_);
  schedule();
}

void Timer::State::schedule() { reactor_->schedule(*this, weak_from_this(), due_); }

void Timer::State::cancel() {
  std::function<void()> dropped;  // what it owns goes when the lock has
  {
    const MutexLock lock(mutex_);
    has_ended_ = true;
    if (calling_ == std::this_thread::get_id()) return;  // plan_next() lets go of the function
    if (calling_ == std::thread::id()) dropped.swap(work_);
  }
  reactor_->cancel(*this);
  if (dropped) return;
  channel::Reactor::about_to_wait();
  const MutexLock lock(mutex_);
  while (calling_ != std::thread::id()) ended_.wait(mutex_);
}

bool Timer::State::is_running() const {
  const MutexLock lock(mutex_);
  return !has_ended_;
}

void Timer::State::on_timer() {
  reactor_->post([self = shared_from_this()] { self->call(); });
}

void Timer::State::call() {
  const std::function<void()>* work = nullptr;
  {
    const MutexLock lock(mutex_);
    if (has_ended_) return;
    if (period_ == nanoseconds(0)) has_ended_ = true;
    calling_ = std::this_thread::get_id();
    work = &work_;  // which nobody changes until plan_next()
  }
  try {
    (*work)();
  } catch (...) {
    report_("a timer's function has thrown: " + endpoint::text_of_current_exception());
  }
  plan_next();
}

void Timer::State::plan_next() {
  std::function<void()> dropped;
  {
    const MutexLock lock(mutex_);
    calling_ = {};
    if (has_ended_) {
      dropped.swap(work_);
    } else {
      const auto late = std::max<nanoseconds>(channel::Clock::now() - due_, nanoseconds(0));
      due_ += (late / period_ + 1) * period_;
      schedule();
    }
  }
  ended_.notify_all();
}

Timer& Timer::operator=(Timer&& other) noexcept {
  if (this == &other) return *this;
  cancel();
  state_ = std::move(other.state_);
  return *this;
}

void Timer::cancel() {
  if (state_) state_->cancel();
}

bool Timer::is_running() const { return state_ && state_->is_running(); }

}  // namespace rr
