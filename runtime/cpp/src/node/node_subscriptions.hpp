// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <memory>

#include "runtime/cpp/src/node/node_state.hpp"
#include "runtime/cpp/src/subscription/owner.hpp"

namespace rr {

/// The subscriptions of a node.
class NodeSubscriptions final : public NodePart {
 public:
  explicit NodeSubscriptions(NodeState& node)
      : owner_(std::make_shared<subscription::Owner>(node.host())) {}

  void end() override { owner_->end(); }
  [[nodiscard]] subscription::Owner& owner() { return *owner_; }

 private:
  const std::shared_ptr<subscription::Owner> owner_;
};

}  // namespace rr
