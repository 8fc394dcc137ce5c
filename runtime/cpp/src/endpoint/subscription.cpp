// SPDX-License-Identifier: Apache-2.0
#include "runtime/cpp/src/endpoint/subscription.hpp"

#include <utility>

#include "runtime/cpp/src/channel/reactor.hpp"

namespace rr {

bool Subscription::Handler::enter() {
  const std::lock_guard lock(mutex_);
  if (!is_connected_) return false;
  is_running_ = true;
  runner_ = std::this_thread::get_id();
  return true;
}

void Subscription::Handler::leave() {
  bool must_drop = false;
  bool is_awaited = false;
  {
    const std::lock_guard lock(mutex_);
    is_running_ = false;
    is_awaited = awaited_ != 0;
    must_drop = !is_connected_ && !std::exchange(is_dropped_, true);
  }
  if (is_awaited) ended_.notify_all();
  if (must_drop) drop();
}

void Subscription::Handler::disconnect() {
  {
    std::unique_lock lock(mutex_);
    is_connected_ = false;
    ++awaited_;
    while (is_running_ && runner_ != std::this_thread::get_id()) ended_.wait(lock);
    --awaited_;
    if (is_running_ || std::exchange(is_dropped_, true)) return;
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
