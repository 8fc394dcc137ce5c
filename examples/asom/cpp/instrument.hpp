// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <array>
#include <cstdint>
#include <memory>
#include <mutex>

#include "RobotCameraHost_interface.hpp"
#include "examples/asom/cpp/optics.hpp"
#include "rr/realtime/lockstep.hpp"
#include "rr/realtime/signals.hpp"
#include "rr/realtime/state_bus.hpp"

namespace asom {

namespace host = RobotCameraHost_interface;

/// Where a two-axis mirror is, each axis from -1 to 1.
struct MirrorAngles {
  double x = 0;
  double y = 0;
};

/// The real-time node of the scanning mirror: two quick axes that go where they are told.
class MirrorNode {
 public:
  /// One cycle of a millisecond.
  void step();
  rr::realtime::CommandGroup<MirrorAngles>& target() { return target_; }
  [[nodiscard]] const rr::realtime::SignalGroup<MirrorAngles>& angles() const { return angles_; }

 private:
  rr::realtime::CommandGroup<MirrorAngles> target_;
  rr::realtime::SignalGroup<MirrorAngles> angles_;
  MirrorAngles now_;
};

/// Mirror, deformable mirror and camera, simulated. The clock goes on while a mirror moves and
/// while the camera is exposed, as in the instrument. May be used by any threads.
class Instrument {
 public:
  Instrument();
  /// Turns the mirror and waits until it stands; cycles that it took.
  int point(double x, double y);
  void push(const std::array<double, actuator_count>& actuators);
  [[nodiscard]] std::array<double, actuator_count> actuators() const;
  [[nodiscard]] MirrorAngles angles() const { return mirror_.angles().read(); }
  Frame expose();

 private:
  mutable std::mutex mutex_;
  Microscope microscope_;
  MirrorNode mirror_;
  rr::realtime::Lockstep lockstep_;
  std::array<double, actuator_count> actuators_{};
};

/// The camera host of the paper's Example 1 with this instrument plugged in: device 0 is the
/// scanning mirror (`Angles`), device 1 the deformable mirror (`Actuators`, in waves), camera 0 the
/// camera.
std::shared_ptr<host::CameraHostSkeleton> make_host(const std::shared_ptr<Instrument>& instrument);

}  // namespace asom
