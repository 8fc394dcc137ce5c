// SPDX-License-Identifier: Apache-2.0
#include "examples/dual_arm/cpp/coordinator.hpp"

#include <algorithm>

#include "rr/realtime/service.hpp"

namespace dual_arm {

namespace {

// Of a stick that is pushed to its end, in units of the axis a second.
constexpr double stick_speed = 0.5;
// Cycles after which a gamepad that says nothing counts as let go: whoever held it may be gone.
constexpr std::uint64_t gamepad_patience = 1000;

}  // namespace

Coordinator::Link::Link()
    : receiver(rr::realtime::layout_of<wire::NodeState>(), lifespan),
      sender(rr::realtime::layout_of<wire::NodeCommand>(), out) {}

Coordinator::Coordinator() {
  for (auto& link : links_) link = std::make_unique<Link>();
}

void Coordinator::make_targets(std::uint64_t sample) {
  silence_ = orders_.take() ? 0 : silence_ + 1;
  const Orders& orders = orders_.value();
  if (table_.begin_sample(sample)) table_begin_ = sample;
  now_.mode = orders.mode;
  if (orders.mode == 1) {
    table_.read(static_cast<double>(sample - table_begin_) * period, targets_);
  } else if (orders.mode == 2 && silence_ < gamepad_patience) {
    // A stick moves the first two axes of an arm; with a button held down, of the bases too.
    for (std::size_t i = 0; i < orders.gamepad.sticks.size(); ++i) {
      const double step = period * stick_speed * std::clamp(orders.gamepad.sticks[i], -1.0, 1.0);
      targets_[(i / 2) * 6 + i % 2] += step;
      if (orders.gamepad.buttons != 0) targets_[12 + (i / 2) * 3 + i % 2] += step;
    }
  }
}

void Coordinator::step(const rr::realtime::Cycle& cycle, rr::realtime::Nanoseconds now) {
  make_targets(cycle.number);
  now_.sample = cycle.number;
  now_.target = targets_;
  for (std::size_t i = 0; i < node_count; ++i) {
    Link& link = *links_[i];
    link.receiver.poll(link.in, now);
    now_.is_fresh[i] = link.receiver.is_fresh(now);
    wire::NodeCommand command{.mode = static_cast<std::uint8_t>(now_.mode != 0 ? 1 : 0)};
    for (std::size_t j = 0; j < 6; ++j) {
      now_.position[6 * i + j] = link.receiver.last().position[j];
      command.target[j] = targets_[6 * i + j];
    }
    link.sender.send(command, now);
  }
  state_.write(now_);
}

}  // namespace dual_arm
