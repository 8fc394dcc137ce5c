// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <string>
#include <vector>

#include "examples/drawing/canvas.hpp"

namespace drawing {

/// A line of a plot: y over x. Values that are not finite are left out.
struct Series {
  std::string name;
  std::vector<double> x;
  std::vector<double> y;
};

struct Plot {
  std::string title;
  std::string x_label;
  std::string y_label;
  std::vector<Series> series;
};

/// Draws the plot into a part of the picture, its axes as long as the values need.
void draw(Canvas& canvas, const Plot& plot, int left, int top, int width, int height);

}  // namespace drawing
