// SPDX-License-Identifier: Apache-2.0
#include "examples/asom/cpp/sharpen.hpp"

#include <algorithm>
#include <cmath>

#include "rr/error.hpp"

namespace asom {

namespace host = RobotCameraHost_interface;

Instruments::Instruments(host::CameraHostStub& root)
    : scanner_(root.get_robdevice(0)),
      mirror_(root.get_robdevice(1)),
      camera_(root.get_robcamera(0)) {}

void Instruments::point(double x, double y) { scanner_->SetProperty("Angles", {x, y}); }

void Instruments::push(const std::array<double, actuator_count>& actuators) {
  mirror_->SetProperty("Actuators", rr::Array<double>(std::span<const double>(actuators)));
}

Frame Instruments::expose() {
  const auto bitmap = camera_->GetCurrentStreamFrameCameraBitmap();
  const bool is_whole = bitmap && bitmap->width > 0 && bitmap->height > 0 &&
                        bitmap->data.size() == static_cast<std::size_t>(bitmap->width) *
                                                   static_cast<std::size_t>(bitmap->height);
  if (!is_whole) throw rr::Error(rr::ErrorCode::operation_failed, "the camera gave no picture");
  ++frames_;
  return {bitmap->width, bitmap->height, {bitmap->data.begin(), bitmap->data.end()}};
}

Sharpened sharpen(Instruments& instruments) {
  constexpr std::size_t first_shape = 2;  // tip and tilt move the picture
  const int frames_before = instruments.frames();
  Sharpened result;
  instruments.push(result.actuators);
  result.flat = result.sharp = instruments.expose();
  double best = sharpness(result.flat);
  const auto consider = [&](const std::array<double, actuator_count>& actuators) {
    instruments.push(actuators);
    Frame frame = instruments.expose();
    const double value = sharpness(frame);
    if (value > best) {
      best = value;
      result.actuators = actuators;
      result.sharp = std::move(frame);
    }
    return value;
  };
  for (const double step : {0.2, 0.1, 0.05}) {
    for (std::size_t shape = first_shape; shape < actuator_count; ++shape) {
      auto tried = result.actuators;
      const double middle = tried[shape];
      const double at_middle = best;
      tried[shape] = middle - step;
      const double below = consider(tried);
      tried[shape] = middle + step;
      const double above = consider(tried);
      const double curvature = below + above - 2 * at_middle;
      if (curvature >= 0) continue;  // no top in between
      tried[shape] = middle + std::clamp(step * (below - above) / (2 * curvature), -step, step);
      consider(tried);
    }
  }
  instruments.push(result.actuators);
  result.frames = instruments.frames() - frames_before;
  return result;
}

}  // namespace asom
