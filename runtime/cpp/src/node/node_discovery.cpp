// SPDX-License-Identifier: Apache-2.0
// Members of Node that need discovery.
#include "runtime/cpp/src/node/node_discovery.hpp"

#include <utility>

#include "rr/discovery.hpp"
#include "runtime/cpp/src/discovery/service_infos.hpp"
#include "runtime/cpp/src/discovery/type_source.hpp"
#include "runtime/cpp/src/node/node_subscriptions.hpp"

namespace rr {

Discovery Node::discovery() const {
  return Discovery(state_->part<NodeDiscoveryPart>(&NodeState::discovery).discovery());
}

ServiceSubscription Node::subscribe_types(std::vector<std::string> types,
                                          SubscriptionOptions options) {
  const auto& discovery = state_->part<NodeDiscoveryPart>(&NodeState::discovery).discovery();
  auto& subscriptions = state_->part<NodeSubscriptions>(&NodeState::subscriptions);
  discovery->ensure_listening();
  ServiceFilter filter = options.filter;
  const auto services = subscriptions.owner().add(std::move(options));
  const auto& watch = discovery->watch_pointer();
  const auto source = std::make_shared<discovery::TypeSource>(watch, state_->core, services,
                                                              std::move(types), std::move(filter));
  services->set_source(source);
  watch->add(source);
  return ServiceSubscription(services);
}

ServiceInfoSubscription Node::subscribe_services(std::vector<std::string> types,
                                                 ServiceFilter filter) {
  const auto& discovery = state_->part<NodeDiscoveryPart>(&NodeState::discovery).discovery();
  const auto& watch = discovery->watch_pointer();
  const auto infos = std::make_shared<discovery::ServiceInfos>(watch, state_->core,
                                                               std::move(types), std::move(filter));
  discovery->ensure_listening();
  watch->add(infos);
  return ServiceInfoSubscription(infos);
}

}  // namespace rr
