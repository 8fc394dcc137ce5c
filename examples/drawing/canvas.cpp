// SPDX-License-Identifier: Apache-2.0
#include "examples/drawing/canvas.hpp"

#include <algorithm>
#include <array>
#include <cctype>
#include <cmath>

#include "examples/drawing/png_file.hpp"

namespace drawing {
namespace {

constexpr int letter_width = 8;

struct Letter {
  char letter;
  std::array<std::uint8_t, 5> rows;
};
constexpr std::array letters{
#include "examples/drawing/letters.inc"
};

}  // namespace

Color color_of(std::size_t number) {
  constexpr std::array<Color, 8> colors{{{31, 119, 180},
                                         {255, 127, 14},
                                         {44, 160, 44},
                                         {214, 39, 40},
                                         {148, 103, 189},
                                         {140, 86, 75},
                                         {227, 119, 194},
                                         {23, 190, 207}}};
  return colors[number % colors.size()];
}

Canvas::Canvas(int width, int height, Color background)
    : width_(width),
      height_(height),
      rgb_(std::size_t{3} * static_cast<std::size_t>(width) * static_cast<std::size_t>(height)) {
  fill(0, 0, width, height, background);
}

Color Canvas::at(int x, int y) const {
  if (x < 0 || y < 0 || x >= width_ || y >= height_) return black;
  const auto place = 3 * static_cast<std::size_t>(y * width_ + x);
  return {rgb_[place], rgb_[place + 1], rgb_[place + 2]};
}

void Canvas::set(int x, int y, Color color) {
  if (x < 0 || y < 0 || x >= width_ || y >= height_) return;
  const auto place = 3 * static_cast<std::size_t>(y * width_ + x);
  rgb_[place] = color.red;
  rgb_[place + 1] = color.green;
  rgb_[place + 2] = color.blue;
}

void Canvas::line(double x0, double y0, double x1, double y1, Color color) {
  const double length = std::max(std::abs(x1 - x0), std::abs(y1 - y0));
  // More steps than a picture has pixels say nothing.
  const int steps = static_cast<int>(std::min(std::ceil(length), 20'000.0));
  for (int i = 0; i <= steps; ++i) {
    const double part = steps == 0 ? 0 : static_cast<double>(i) / steps;
    set(static_cast<int>(std::lround(x0 + part * (x1 - x0))),
        static_cast<int>(std::lround(y0 + part * (y1 - y0))), color);
  }
}

void Canvas::fill(int left, int top, int width, int height, Color color) {
  for (int y = top; y < top + height; ++y) {
    for (int x = left; x < left + width; ++x) set(x, y, color);
  }
}

void Canvas::disk(double x, double y, double radius, Color color) {
  const int size = static_cast<int>(std::ceil(radius));
  for (int dy = -size; dy <= size; ++dy) {
    for (int dx = -size; dx <= size; ++dx) {
      if (dx * dx + dy * dy > radius * radius) continue;
      set(static_cast<int>(std::lround(x)) + dx, static_cast<int>(std::lround(y)) + dy, color);
    }
  }
}

void Canvas::text(int x, int y, std::string_view text, Color color) {
  for (const char raw : text) {
    const char wanted = static_cast<char>(std::toupper(static_cast<unsigned char>(raw)));
    const auto* const letter = std::ranges::find(letters, wanted, &Letter::letter);
    for (int row = 0; letter != letters.end() && row < 5; ++row) {
      for (int column = 0; column < 3; ++column) {
        const bool is_set =
            ((letter->rows[static_cast<std::size_t>(row)] >> (2 - column)) & 1) != 0;
        if (is_set) fill(x + 2 * column, y + 2 * row, 2, 2, color);
      }
    }
    x += letter_width;
  }
}

void Canvas::picture(int left, int top, int width, int height, std::span<const std::uint8_t> rgb) {
  for (int y = 0; y < height; ++y) {
    for (int x = 0; x < width; ++x) {
      const auto place = 3 * static_cast<std::size_t>(y * width + x);
      if (place + 2 >= rgb.size()) return;
      set(left + x, top + y, {rgb[place], rgb[place + 1], rgb[place + 2]});
    }
  }
}

void Canvas::write(const std::string& file) const { write_png(file, width_, height_, rgb_); }

int text_width(std::string_view text) { return letter_width * static_cast<int>(text.size()); }

}  // namespace drawing
