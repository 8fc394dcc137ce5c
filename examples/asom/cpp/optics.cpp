// SPDX-License-Identifier: Apache-2.0
#include "examples/asom/cpp/optics.hpp"

#include <algorithm>
#include <cmath>
#include <complex>
#include <numbers>

namespace asom {
namespace {

constexpr int specimen_size = 192;
constexpr int pupil_size = 17;  // samples across the pupil
constexpr int spread_size = 9;  // pixels across the image of a point
constexpr int spread_middle = spread_size / 2;

// Shapes of a wave front over the unit disk.
std::array<double, actuator_count> shapes(double x, double y) {
  const double r = x * x + y * y;
  return {x,
          y,
          2 * r - 1,
          x * x - y * y,
          2 * x * y,
          (3 * r - 2) * x,
          (3 * r - 2) * y,
          6 * r * r - 6 * r + 1,
          x * (x * x - 3 * y * y)};
}

// What the lenses do to the wave front there, in waves, by the same shapes; nothing to where the
// picture lies.
std::array<double, actuator_count> errors(double x, double y) {
  const double r = std::hypot(x, y);
  return {0, 0, 0.15 + 0.30 * r, 0.25 * x, -0.25 * y, 0.12 * x, 0.12 * y, 0.10 * r, 0};
}

std::vector<std::uint8_t> make_specimen() {
  std::vector<std::uint8_t> gray(std::size_t{specimen_size} * specimen_size, 20);
  const auto set = [&](int x, int y, std::uint8_t value) {
    if (x < 0 || y < 0 || x >= specimen_size || y >= specimen_size) return;
    gray[static_cast<std::size_t>(y * specimen_size + x)] = value;
  };
  // Cells in a loose order, each with a rim and a few grains.
  std::uint32_t random = 12345;
  const auto next = [&random](int below) {
    random = random * 1664525U + 1013904223U;
    return static_cast<int>((random >> 16U) % static_cast<std::uint32_t>(below));
  };
  for (int cell = 0; cell < 120; ++cell) {
    const int middle_x = next(specimen_size);
    const int middle_y = next(specimen_size);
    const int radius = 4 + next(6);
    for (int dy = -radius; dy <= radius; ++dy) {
      for (int dx = -radius; dx <= radius; ++dx) {
        const double distance = std::hypot(dx, dy);
        if (distance > radius) continue;
        set(middle_x + dx, middle_y + dy, distance > radius - 1.5 ? 230 : 90);
      }
    }
    for (int grain = 0; grain < 4; ++grain) {
      const int y = middle_y + next(radius) - radius / 2;
      const int x = middle_x + next(radius) - radius / 2;
      set(x, y, 255);
    }
  }
  return gray;
}

Frame to_frame(const std::vector<double>& light) {
  Frame frame{Microscope::frame_size, Microscope::frame_size, {}};
  for (const double value : light) {
    frame.gray.push_back(static_cast<std::uint8_t>(std::lround(std::clamp(value, 0.0, 255.0))));
  }
  return frame;
}

}  // namespace

Microscope::Microscope() : specimen_(make_specimen()) {}

// With a border, which the spread light of the picture's edge comes from.
std::vector<double> Microscope::view(double x, double y) const {
  constexpr int size = frame_size + 2 * spread_middle;
  const double reach = (specimen_size - frame_size) / 2.0;
  const int left = static_cast<int>(std::lround(reach * (1 + std::clamp(x, -1.0, 1.0))));
  const int top = static_cast<int>(std::lround(reach * (1 + std::clamp(y, -1.0, 1.0))));
  std::vector<double> light;
  for (int row = 0; row < size; ++row) {
    for (int column = 0; column < size; ++column) {
      const int from_x = std::clamp(left + column - spread_middle, 0, specimen_size - 1);
      const int from_y = std::clamp(top + row - spread_middle, 0, specimen_size - 1);
      light.push_back(specimen_[static_cast<std::size_t>(from_y * specimen_size + from_x)]);
    }
  }
  return light;
}

// The image of a point: the square of the Fourier transform of the wave over the pupil.
std::vector<double> Microscope::spread(double x, double y,
                                       const std::array<double, actuator_count>& actuators) const {
  const auto wrong = errors(x, y);
  struct Sample {
    double x;
    double y;
    double waves;
  };
  std::vector<Sample> pupil;
  for (int j = 0; j < pupil_size; ++j) {
    for (int i = 0; i < pupil_size; ++i) {
      Sample sample{2.0 * i / (pupil_size - 1) - 1, 2.0 * j / (pupil_size - 1) - 1, 0};
      if (sample.x * sample.x + sample.y * sample.y > 1) continue;
      const auto shape = shapes(sample.x, sample.y);
      for (std::size_t k = 0; k < actuator_count; ++k) {
        sample.waves += (wrong[k] + actuators[k]) * shape[k];
      }
      pupil.push_back(sample);
    }
  }
  std::vector<double> result;
  double sum = 0;
  for (int v = -spread_middle; v <= spread_middle; ++v) {
    for (int u = -spread_middle; u <= spread_middle; ++u) {
      std::complex<double> field = 0;
      for (const Sample& at : pupil) {
        const double waves = at.waves - 0.4 * (u * at.x + v * at.y);
        field += std::polar(1.0, 2 * std::numbers::pi * waves);
      }
      result.push_back(std::norm(field));
      sum += result.back();
    }
  }
  for (double& value : result) value /= sum;
  return result;
}

Frame Microscope::expose(double x, double y,
                         const std::array<double, actuator_count>& actuators) const {
  constexpr int size = frame_size + 2 * spread_middle;
  const std::vector<double> from = view(x, y);
  const std::vector<double> point = spread(x, y, actuators);
  std::vector<double> light;
  for (int row = 0; row < frame_size; ++row) {
    for (int column = 0; column < frame_size; ++column) {
      double sum = 0;
      for (int v = 0; v < spread_size; ++v) {
        for (int u = 0; u < spread_size; ++u) {
          sum += point[static_cast<std::size_t>(v * spread_size + u)] *
                 from[static_cast<std::size_t>((row + v) * size + column + u)];
        }
      }
      light.push_back(sum);
    }
  }
  return to_frame(light);
}

Frame Microscope::ideal(double x, double y) const {
  constexpr int size = frame_size + 2 * spread_middle;
  const std::vector<double> from = view(x, y);
  std::vector<double> light;
  for (int row = 0; row < frame_size; ++row) {
    for (int column = 0; column < frame_size; ++column) {
      light.push_back(
          from[static_cast<std::size_t>((row + spread_middle) * size + column + spread_middle)]);
    }
  }
  return to_frame(light);
}

double sharpness(const Frame& frame) {
  double sum = 0;
  for (int y = 1; y < frame.height; ++y) {
    for (int x = 1; x < frame.width; ++x) {
      const auto at = [&](int column, int row) {
        return double{frame.gray[static_cast<std::size_t>(row * frame.width + column)] * 1.0};
      };
      const double across = at(x, y) - at(x - 1, y);
      const double down = at(x, y) - at(x, y - 1);
      sum += across * across + down * down;
    }
  }
  return sum / static_cast<double>(frame.gray.size());
}

}  // namespace asom
