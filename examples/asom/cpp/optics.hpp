// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <array>
#include <cstddef>
#include <cstdint>
#include <vector>

namespace asom {

/// Patches of the deformable mirror that are driven on their own.
inline constexpr std::size_t actuator_count = 9;

/// A picture of one byte a pixel.
struct Frame {
  int width = 0;
  int height = 0;
  std::vector<std::uint8_t> gray;
};

/// Simulated optics of an adaptive scanning microscope: a specimen that is larger than what the
/// camera sees, a mirror that chooses what it sees, lenses that spoil the wave front the more the
/// farther from the axis they look, and a deformable mirror that can mend it. The same settings
/// give the same pictures.
class Microscope {
 public:
  static constexpr int frame_size = 64;

  Microscope();

  /// What the camera sees: `x` and `y` say where, from -1 to 1; the actuators push the mirror, in
  /// waves.
  [[nodiscard]] Frame expose(double x, double y,
                             const std::array<double, actuator_count>& actuators) const;
  /// The same without any error of the lenses.
  [[nodiscard]] Frame ideal(double x, double y) const;

 private:
  [[nodiscard]] std::vector<double> view(double x, double y) const;
  [[nodiscard]] std::vector<double> spread(
      double x, double y, const std::array<double, actuator_count>& actuators) const;

  std::vector<std::uint8_t> specimen_;
};

/// How sharp a picture is: the mean square of the differences of neighbours.
double sharpness(const Frame& frame);

/// Pixels across the middle of a frame, which is what goes into a mosaic.
inline constexpr int tile_size = 48;

}  // namespace asom
