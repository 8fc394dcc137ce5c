// SPDX-License-Identifier: Apache-2.0
#include "examples/microassembly/cpp/node.hpp"

#include <algorithm>
#include <cmath>

namespace microassembly {
namespace {

// The probes' rests, to both sides of the table's middle.
constexpr double rest = 500;
// A step of the coarse axes, and how far they go in a cycle; the reach of the fine ones.
constexpr double coarse_step = 1.25;
constexpr double coarse_speed = 1.0;
constexpr double fine_reach = 20;
constexpr double stage_speed = 0.5;

bool is_coarse(std::size_t axis) { return axis < 12 && axis % 6 < 3; }
bool is_fine(std::size_t axis) { return axis < 12 && axis % 6 >= 3; }

}  // namespace

std::array<double, 3> tip(const wire::AxesState& state, std::size_t probe) {
  std::array<double, 3> at{};
  for (std::size_t i = 0; i < 3; ++i) {
    at[i] = state.position[6 * probe + i] + state.position[6 * probe + 3 + i];
  }
  at[0] += probe == 0 ? -rest : rest;
  return at;
}

void Node::move_axes() {
  now_.is_moving = false;
  for (std::size_t axis = 0; axis < axis_count; ++axis) {
    double& exact = exact_[axis];
    double wanted = wanted_[axis];
    if (is_fine(axis)) {
      wanted = std::clamp(wanted, -fine_reach, fine_reach);
      exact += 0.3 * (wanted - exact);  // quick, with a time constant of 3 ms
    } else {
      const double speed = is_coarse(axis) ? coarse_speed : stage_speed;
      exact += std::clamp(wanted - exact, -speed, speed);
    }
    now_.is_moving = now_.is_moving || std::abs(wanted - exact) > 0.01;
    now_.position[axis] = is_coarse(axis) ? coarse_step * std::round(exact / coarse_step) : exact;
  }
}

void Node::move_part() {
  const auto left = tip(now_, 0);
  const auto right = tip(now_, 1);
  const bool was_gripped = now_.is_gripped;
  const bool are_low = std::abs(left[2]) < 5 && std::abs(right[2]) < 5;
  const double x = now_.part[0];
  const double y = now_.part[1];
  // Held as long as both tips press; they may carry it above the stage.
  const bool do_press =
      right[0] - left[0] <= 2 * part_size && std::abs(left[1] - right[1]) < part_size;
  const bool are_near = std::abs((left[0] + right[0]) / 2 - x) < 10 &&
                        std::abs(left[1] - y) < part_size && std::abs(right[1] - y) < part_size;
  now_.is_gripped = do_press && (was_gripped || (are_low && are_near));
  if (now_.is_gripped && was_gripped) {
    now_.part = {(left[0] + right[0]) / 2, (left[1] + right[1]) / 2};
  }
}

void Node::step(const rr::realtime::Cycle& cycle) {
  // The newer of the two counts: a target ends the table, a table the target.
  if (table_.begin_sample(cycle.number)) {
    table_begin_ = cycle.number;
    is_on_table_ = true;
  }
  if (target_.take()) {
    wanted_ = target_.value().position;
    is_on_table_ = false;
  }
  if (is_on_table_) {
    table_.read(static_cast<double>(cycle.number - table_begin_) * 0.001, wanted_);
  }
  const double stage_x = now_.position[12];
  const double stage_y = now_.position[13];
  move_axes();
  if (!now_.is_gripped) {  // lies on the stage
    now_.part[0] += now_.position[12] - stage_x;
    now_.part[1] += now_.position[13] - stage_y;
  }
  move_part();
  now_.sample = cycle.number;
  state_.write(now_);
}

}  // namespace microassembly
