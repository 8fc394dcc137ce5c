// SPDX-License-Identifier: Apache-2.0
#include <gtest/gtest.h>

#include <algorithm>
#include <limits>

#include "examples/drawing/plot.hpp"

namespace drawing {
namespace {

std::ptrdiff_t pixels_of(const Canvas& canvas, Color color) {
  std::ptrdiff_t count = 0;
  for (int y = 0; y < canvas.height(); ++y) {
    for (int x = 0; x < canvas.width(); ++x) count += canvas.at(x, y) == color ? 1 : 0;
  }
  return count;
}

TEST(Drawing, LinesGoFromEndToEndAndStayInside) {
  Canvas canvas(10, 10);
  canvas.line(0, 0, 9, 9, black);
  EXPECT_EQ(canvas.at(0, 0), black);
  EXPECT_EQ(canvas.at(9, 9), black);
  EXPECT_EQ(pixels_of(canvas, black), 10);
  canvas.line(-50, 5, 50, 5, gray);
  EXPECT_EQ(pixels_of(canvas, gray), 10);
}

TEST(Drawing, LettersAreThreeByFiveDoubled) {
  Canvas canvas(8, 12);
  canvas.text(0, 0, "1");
  EXPECT_EQ(pixels_of(canvas, black), 4 * (1 + 2 + 1 + 1 + 3));
  EXPECT_EQ(canvas.at(2, 0), black);
  EXPECT_EQ(canvas.at(0, 0), white);
}

TEST(Drawing, APlotShowsItsSeriesInTheirColors) {
  Canvas canvas(400, 300);
  const double nan = std::numeric_limits<double>::quiet_NaN();
  draw(canvas, {"T", "S", "", {{"A", {0, 1, 2}, {0, 1, 0}}, {"B", {0, 1, 2}, {nan, 2, 2}}}}, 0, 0,
       400, 300);
  EXPECT_GT(pixels_of(canvas, color_of(0)), 200);
  EXPECT_GT(pixels_of(canvas, color_of(1)), 100);
}

}  // namespace
}  // namespace drawing
