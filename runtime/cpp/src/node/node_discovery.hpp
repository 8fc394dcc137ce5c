// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <memory>

#include "runtime/cpp/src/discovery/node_discovery.hpp"
#include "runtime/cpp/src/node/node_state.hpp"

namespace rr {

/// How a node finds others and is found.
class NodeDiscoveryPart final : public NodePart {
 public:
  explicit NodeDiscoveryPart(NodeState& node)
      : discovery_(std::make_shared<discovery::NodeDiscovery>(
            node.host(), [places = node.places] { return places->urls(); })) {}

  void end() override { discovery_->end(); }
  [[nodiscard]] const std::shared_ptr<discovery::NodeDiscovery>& discovery() const {
    return discovery_;
  }

 private:
  const std::shared_ptr<discovery::NodeDiscovery> discovery_;
};

}  // namespace rr
