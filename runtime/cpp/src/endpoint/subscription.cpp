// SPDX-License-Identifier: Apache-2.0
#include "runtime/cpp/src/endpoint/subscription.hpp"

#include <utility>

#include "runtime/cpp/src/channel/reactor.hpp"

namespace rr {

[[gnu::hot]] bool Subscription::Handler::enter() {
  runner_.store(std::this_thread::get_id(), std::memory_order_relaxed);  // before it is running
  if ((state_.fetch_or(running) & disconnected) == 0) return true;
  leave();
  return false;
}

[[gnu::hot]] void Subscription::Handler::leave() {
  if ((state_.fetch_and(~running) & disconnected) != 0 && leave_disconnected()) drop();
}

// True when the function is to be dropped.
bool Subscription::Handler::leave_disconnected() {
  const MutexLock lock(mutex_);
  ended_.notify_all();
  return !std::exchange(is_dropped_, true);
}

void Subscription::Handler::disconnect() {
  {
    const MutexLock lock(mutex_);
    state_.fetch_or(disconnected);
    const auto self = std::this_thread::get_id();
    while ((state_.load() & running) != 0) {
      if (runner_.load(std::memory_order_relaxed) == self) return;  // it drops when it leaves
      ended_.wait(mutex_);
    }
    if (std::exchange(is_dropped_, true)) return;
  }
  drop();
}

Subscription::Subscription(std::shared_ptr<Handler> handler) : handler_(std::move(handler)) {}
Subscription::Subscription(Subscription&& other) noexcept = default;

Subscription& Subscription::operator=(Subscription&& other) noexcept {
  if (this != &other) {
    disconnect();
    handler_ = std::move(other.handler_);
  }
  return *this;
}

Subscription::~Subscription() { disconnect(); }

void Subscription::disconnect() {
  if (!handler_) return;
  handler_->disconnect();
  handler_.reset();
}

void Subscription::detach() { handler_.reset(); }

}  // namespace rr
