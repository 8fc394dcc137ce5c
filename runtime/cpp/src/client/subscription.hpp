// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <memory>
#include <string>
#include <utility>

#include "rr/definition.hpp"
#include "rr/stub.hpp"
#include "runtime/cpp/src/endpoint/subscription.hpp"

namespace rr::client {

/// A function that waits for an event of one object.
class EventSubscription final : public Subscription::Handler {
 public:
  EventSubscription(const Stub& of, const Member& event, std::unique_ptr<EventHandler> function)
      : stub(&of), path(of.rr_path()), member(&event), function_(std::move(function)) {}

  const Stub* const stub;  // compared only
  const std::string path;
  const Member* const member;

  /// Calls the function unless it has been disconnected. What it throws comes out.
  void call(const Arguments& arguments) {
    run([&] { function_->call(arguments); });
  }

 private:
  void drop() override { function_.reset(); }

  std::unique_ptr<EventHandler> function_;
};

}  // namespace rr::client
