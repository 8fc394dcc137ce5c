// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <functional>
#include <memory>

#include "runtime/cpp/src/client/session.hpp"
#include "runtime/cpp/src/endpoint/core.hpp"

namespace rr::subscription {

/// What a node does for its subscriptions.
struct Host {
  std::shared_ptr<endpoint::Core> core;
  /// Node::run_aside. Called on threads of the node only, which its end waits for.
  std::function<void(std::function<void()>)> run_aside;
  /// Ends a session when the node is shut down. Throws rr::Error when it has been.
  std::function<void(const std::shared_ptr<Session>&)> keep;
};

}  // namespace rr::subscription
