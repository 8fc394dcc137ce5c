// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <cstdint>
#include <span>
#include <string>
#include <string_view>
#include <vector>

namespace drawing {

/// Red, green, blue.
struct Color {
  std::uint8_t red = 0;
  std::uint8_t green = 0;
  std::uint8_t blue = 0;

  bool operator==(const Color&) const = default;
};

inline constexpr Color black{0, 0, 0};
inline constexpr Color white{255, 255, 255};
inline constexpr Color gray{170, 170, 170};

/// The color of the n-th of several things; begins anew after eight.
Color color_of(std::size_t number);

/// A picture to draw on, pixels from its upper left corner. What lies outside is left out.
class Canvas {
 public:
  Canvas(int width, int height, Color background = white);

  [[nodiscard]] int width() const { return width_; }
  [[nodiscard]] int height() const { return height_; }
  /// Black outside.
  [[nodiscard]] Color at(int x, int y) const;
  /// Three bytes a pixel, rows from the top.
  [[nodiscard]] std::span<const std::uint8_t> rgb() const { return rgb_; }

  void set(int x, int y, Color color);
  void line(double x0, double y0, double x1, double y1, Color color);
  void fill(int left, int top, int width, int height, Color color);
  void disk(double x, double y, double radius, Color color);
  /// Letters of 3 x 5 pixels, doubled, from the upper left corner on: digits, letters (all as
  /// capitals), blanks and `. - + : / = ,`; others are blanks.
  void text(int x, int y, std::string_view text, Color color = black);
  /// Another picture's three bytes a pixel, with its upper left corner there.
  void picture(int left, int top, int width, int height, std::span<const std::uint8_t> rgb);

  void write(const std::string& file) const;

 private:
  int width_;
  int height_;
  std::vector<std::uint8_t> rgb_;
};

/// Pixels that a text is wide.
int text_width(std::string_view text);

}  // namespace drawing
