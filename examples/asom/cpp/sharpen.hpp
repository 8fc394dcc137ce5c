// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <array>
#include <memory>

#include "RobotCameraHost_interface.hpp"
#include "examples/asom/cpp/optics.hpp"

namespace asom {

/// The instrument as a client has it: nothing but the host's devices and camera.
class Instruments {
 public:
  explicit Instruments(RobotCameraHost_interface::CameraHostStub& root);
  void point(double x, double y);
  void push(const std::array<double, actuator_count>& actuators);
  Frame expose();
  [[nodiscard]] int frames() const { return frames_; }

 private:
  std::shared_ptr<RobotCameraHost_interface::RobotDeviceStub> scanner_;
  std::shared_ptr<RobotCameraHost_interface::RobotDeviceStub> mirror_;
  std::shared_ptr<RobotCameraHost_interface::RobotCameraStub> camera_;
  int frames_ = 0;
};

struct Sharpened {
  Frame flat;
  Frame sharp;
  std::array<double, actuator_count> actuators{};
  int frames = 0;  ///< that it took
};

/// Closes the loop over camera and deformable mirror: tries each shape but those that only move the
/// picture a little to both sides, goes to the top of the parabola through the three values of
/// sharpness, and does so again with smaller steps. The mirror stays as it was best.
Sharpened sharpen(Instruments& instruments);

}  // namespace asom
