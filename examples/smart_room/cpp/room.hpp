// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <array>
#include <cstddef>
#include <cstdint>
#include <mutex>
#include <vector>

namespace smart_room {

/// Red, green, blue; 0 is dark, 1 is a lamp's full power.
struct Color {
  double red = 0;
  double green = 0;
  double blue = 0;

  bool operator==(const Color&) const = default;
};

/// A place in the room in metres: x to the east, y to the north, z up from the floor.
struct Place {
  double x = 0;
  double y = 0;
  double z = 0;
};

/// A picture, three bytes (red, green, blue) a pixel, rows from the north, pixels from the west.
struct Picture {
  int width = 0;
  int height = 0;
  std::vector<std::uint8_t> rgb;
};

/// A simulated room of 8 x 6 x 3 m: lamps in the ceiling that can shine in any color, color sensors
/// on the furniture, and four cameras in the ceiling, one above each quarter. Everything is
/// computed from the lamps' colors, so the same settings give the same readings and pictures. May
/// be used from several threads at once.
class Room {
 public:
  static constexpr std::size_t light_count = 6;
  static constexpr std::size_t sensor_count = 4;
  static constexpr std::size_t camera_count = 4;
  static constexpr int picture_width = 320;
  static constexpr int picture_height = 240;

  Room();

  /// Sets lamps `first` to `last`, counted from 1. Throws std::out_of_range when there is no such
  /// lamp.
  void set_lights(std::size_t first, std::size_t last, Color color);
  [[nodiscard]] std::array<Color, light_count> lights() const;
  /// What a sensor measures, counted from 0: light from all lamps that reaches it.
  [[nodiscard]] Color sensor(std::size_t index) const;
  [[nodiscard]] static Place light_place(std::size_t index);
  [[nodiscard]] static Place sensor_place(std::size_t index);
  [[nodiscard]] static Place camera_place(std::size_t index);
  /// What a camera sees of the floor below it.
  [[nodiscard]] Picture picture(std::size_t camera) const;

 private:
  mutable std::mutex mutex_;
  std::array<Color, light_count> lights_;
};

}  // namespace smart_room
