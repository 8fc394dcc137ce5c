// SPDX-License-Identifier: Apache-2.0
#include "examples/smart_room/cpp/room.hpp"

#include <algorithm>
#include <cmath>
#include <stdexcept>
#include <string>

namespace smart_room {
namespace {

constexpr double room_height = 3;
// Half of what one camera covers, in metres: a quarter of the floor.
constexpr double half_width = 2;
constexpr double half_depth = 1.5;

constexpr std::array<Place, Room::light_count> light_places{{{1.5, 1.5, room_height},
                                                             {4, 1.5, room_height},
                                                             {6.5, 1.5, room_height},
                                                             {1.5, 4.5, room_height},
                                                             {4, 4.5, room_height},
                                                             {6.5, 4.5, room_height}}};
constexpr std::array<Place, Room::sensor_count> sensor_places{
    {{1.2, 1.2, 0.8}, {6.8, 1.2, 0.8}, {1.2, 4.8, 0.8}, {6.8, 4.8, 0.8}}};
constexpr std::array<Place, Room::camera_count> camera_places{
    {{2, 4.5, room_height}, {6, 4.5, room_height}, {2, 1.5, room_height}, {6, 1.5, room_height}}};

Color plus(const Color& a, const Color& b, double weight) {
  return {a.red + b.red * weight, a.green + b.green * weight, a.blue + b.blue * weight};
}

/// Light that falls on a level surface: each lamp by the inverse square of its distance and the
/// cosine at the lamp and at the surface.
Color illumination(const std::array<Color, Room::light_count>& lights, const Place& at) {
  Color sum;
  for (std::size_t i = 0; i < lights.size(); ++i) {
    const double dx = light_places[i].x - at.x;
    const double dy = light_places[i].y - at.y;
    const double dz = light_places[i].z - at.z;
    const double square = dx * dx + dy * dy + dz * dz;
    sum = plus(sum, lights[i], dz * dz / (square * square));
  }
  return sum;
}

/// The color of what lies at a place on the floor: tiles, two tables, a round rug.
Color surface(double x, double y) {
  const auto inside = [&](double left, double bottom, double right, double top) {
    return x >= left && x < right && y >= bottom && y < top;
  };
  if (inside(0.6, 0.8, 2.2, 1.7) || inside(5.9, 4.3, 7.6, 5.3)) return {0.72, 0.52, 0.33};
  if (std::hypot(x - 4, y - 3) < 1.1) return {0.35, 0.45, 0.62};
  const auto tile = static_cast<int>(std::floor(x * 2)) + static_cast<int>(std::floor(y * 2));
  return tile % 2 == 0 ? Color{0.85, 0.85, 0.82} : Color{0.66, 0.66, 0.68};
}

std::uint8_t exposed(double light, double reflectance) {
  // Bright parts are compressed instead of cut off, so that a lamp's color stays visible below it.
  const double value = 14 * light * reflectance;
  return static_cast<std::uint8_t>(std::lround(255 * (1 - std::exp(-value))));
}

}  // namespace

Room::Room() { lights_.fill({0.4, 0.4, 0.4}); }

void Room::set_lights(std::size_t first, std::size_t last, Color color) {
  if (first < 1 || last < first || last > light_count) {
    throw std::out_of_range("lights are counted from 1 to " + std::to_string(light_count));
  }
  const std::scoped_lock lock(mutex_);
  std::fill(lights_.begin() + static_cast<std::ptrdiff_t>(first - 1),
            lights_.begin() + static_cast<std::ptrdiff_t>(last), color);
}

std::array<Color, Room::light_count> Room::lights() const {
  const std::scoped_lock lock(mutex_);
  return lights_;
}

Color Room::sensor(std::size_t index) const {
  return illumination(lights(), sensor_places.at(index));
}

Place Room::light_place(std::size_t index) { return light_places.at(index); }
Place Room::sensor_place(std::size_t index) { return sensor_places.at(index); }
Place Room::camera_place(std::size_t index) { return camera_places.at(index); }

Picture Room::picture(std::size_t camera) const {
  const Place& center = camera_places.at(camera);
  const auto now = lights();
  Picture result{picture_width, picture_height, {}};
  result.rgb.reserve(std::size_t{3} * picture_width * picture_height);
  for (int row = 0; row < picture_height; ++row) {
    const double y = center.y + half_depth * (1 - (2 * row + 1) / double{picture_height});
    for (int column = 0; column < picture_width; ++column) {
      const double x = center.x + half_width * ((2 * column + 1) / double{picture_width} - 1);
      const Color light = illumination(now, {x, y, 0});
      const Color floor = surface(x, y);
      result.rgb.push_back(exposed(light.red, floor.red));
      result.rgb.push_back(exposed(light.green, floor.green));
      result.rgb.push_back(exposed(light.blue, floor.blue));
    }
  }
  return result;
}

}  // namespace smart_room
