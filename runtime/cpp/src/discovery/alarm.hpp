// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <functional>
#include <memory>
#include <utility>

#include "runtime/cpp/src/channel/reactor.hpp"

namespace rr::discovery {

/// Calls a function at a time, on a thread of the node.
class Alarm final : public channel::Timer, public std::enable_shared_from_this<Alarm> {
 public:
  Alarm(std::shared_ptr<channel::Reactor> reactor, std::function<void()> function)
      : reactor_(std::move(reactor)), function_(std::move(function)) {}
  ~Alarm() { reactor_->cancel(*this); }

  /// Replaces an earlier time.
  void set(channel::Time when) { reactor_->schedule(*this, weak_from_this(), when); }
  void cancel() { reactor_->cancel(*this); }

 private:
  void on_timer() override {
    reactor_->post([self = shared_from_this()] { self->function_(); });
  }

  const std::shared_ptr<channel::Reactor> reactor_;
  const std::function<void()> function_;
};

}  // namespace rr::discovery
