// SPDX-License-Identifier: Apache-2.0
// Members of Node that need subscriptions.
#include "runtime/cpp/src/node/node_subscriptions.hpp"

#include <utility>

namespace rr {

ServiceSubscription Node::subscribe_to(std::vector<std::vector<std::string>> services,
                                       SubscriptionOptions options) {
  auto& part = state_->part<NodeSubscriptions>(&NodeState::subscriptions);
  return ServiceSubscription(part.owner().add(std::move(services), std::move(options)));
}

}  // namespace rr
