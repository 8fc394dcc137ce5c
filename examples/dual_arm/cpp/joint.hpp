// SPDX-License-Identifier: Apache-2.0
#pragma once

namespace dual_arm {

/// Seconds of a cycle.
inline constexpr double period = 0.001;

/// An axis with its servo: drawn to its target like by a spring, slowed down so that it does not
/// swing.
struct Joint {
  static constexpr double stiffness = 900;  // 1/s^2
  static constexpr double damping = 60;     // 1/s

  double position = 0;
  double speed = 0;

  /// One cycle.
  void step(double target) {
    speed += period * (stiffness * (target - position) - damping * speed);
    position += period * speed;
  }
};

}  // namespace dual_arm
