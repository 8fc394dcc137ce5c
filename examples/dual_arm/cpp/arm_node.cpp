// SPDX-License-Identifier: Apache-2.0
#include "examples/dual_arm/cpp/arm_node.hpp"

#include "rr/realtime/service.hpp"

namespace dual_arm {

ArmNode::ArmNode()
    : receiver_(rr::realtime::layout_of<wire::NodeCommand>(), lifespan),
      sender_(rr::realtime::layout_of<wire::NodeState>(), out_) {}

void ArmNode::step(const rr::realtime::Cycle& cycle, rr::realtime::Nanoseconds now) {
  receiver_.poll(in_, now);
  const wire::NodeCommand* const command = receiver_.newest(now);
  const bool is_following = command != nullptr && command->mode != 0;
  if (is_following) target_ = command->target;
  // The world has gone on in cycles that were skipped.
  for (; next_sample_ <= cycle.number; ++next_sample_) {
    for (std::size_t i = 0; i < joints_.size(); ++i) joints_[i].step(target_[i]);
  }
  wire::NodeState state{.sample = cycle.number, .is_following = is_following};
  for (std::size_t i = 0; i < joints_.size(); ++i) {
    state.position[i] = joints_[i].position;
    state.speed[i] = joints_[i].speed;
  }
  sender_.send(state, now);
}

}  // namespace dual_arm
