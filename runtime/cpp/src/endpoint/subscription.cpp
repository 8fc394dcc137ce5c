// SPDX-License-Identifier: Apache-2.0
#include "runtime/cpp/src/endpoint/subscription.hpp"

#include <utility>

#include "runtime/cpp/src/channel/reactor.hpp"

namespace rr {

void Subscription::Handler::call(const Arguments& arguments) {
  run([&] { function_->call(arguments); });
}

void Subscription::Handler::run(const std::function<void()>& what) {
  {
    const std::lock_guard lock(mutex_);
    if (!is_connected_) return;
    is_running_ = true;
    runner_ = std::this_thread::get_id();
  }
  struct End {
    Handler& handler;
    ~End() {
      {
        const std::lock_guard lock(handler.mutex_);
        handler.is_running_ = false;
      }
      handler.ended_.notify_all();
    }
  } const end{*this};
  what();
}

void Subscription::Handler::disconnect() {
  std::unique_lock lock(mutex_);
  is_connected_ = false;
  while (is_running_ && runner_ != std::this_thread::get_id()) ended_.wait(lock);
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
