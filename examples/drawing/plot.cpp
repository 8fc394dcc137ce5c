// SPDX-License-Identifier: Apache-2.0
#include "examples/drawing/plot.hpp"

#include <algorithm>
#include <cmath>
#include <cstdio>

namespace drawing {
namespace {

struct Range {
  double low = 0;
  double high = 1;

  [[nodiscard]] double part(double value) const { return (value - low) / (high - low); }
};

Range range_of(const Plot& plot, std::vector<double> Series::*values) {
  bool is_empty = true;
  Range range;
  for (const Series& series : plot.series) {
    for (const double value : series.*values) {
      if (!std::isfinite(value)) continue;
      range.low = is_empty ? value : std::min(range.low, value);
      range.high = is_empty ? value : std::max(range.high, value);
      is_empty = false;
    }
  }
  if (range.high - range.low < 1e-12) range = {range.low - 0.5, range.low + 0.5};
  return range;
}

std::string number_text(double value) {
  char text[32];
  std::snprintf(text, sizeof text, "%.3g", value);
  return text;
}

}  // namespace

void draw(Canvas& canvas, const Plot& plot, int left, int top, int width, int height) {
  constexpr int margin = 56;
  constexpr int ticks = 4;
  const Range x = range_of(plot, &Series::x);
  const Range y = range_of(plot, &Series::y);
  const int x0 = left + margin;
  const int y0 = top + height - margin / 2 - 12;
  const int inner_width = width - margin - 12;
  const int inner_height = height - margin - 12;
  canvas.text(x0, top + 6, plot.title);
  canvas.text(left + width - 12 - text_width(plot.x_label), top + height - 12, plot.x_label);
  canvas.text(left + 4, top + 6, plot.y_label);
  for (int i = 0; i <= ticks; ++i) {
    const double part = static_cast<double>(i) / ticks;
    const double at_x = x0 + part * inner_width;
    const double at_y = y0 - part * inner_height;
    canvas.line(at_x, y0, at_x, y0 - inner_height, gray);
    canvas.line(x0, at_y, x0 + inner_width, at_y, gray);
    const std::string x_text = number_text(x.low + part * (x.high - x.low));
    canvas.text(static_cast<int>(at_x) - text_width(x_text) / 2, y0 + 4, x_text);
    const std::string y_text = number_text(y.low + part * (y.high - y.low));
    canvas.text(x0 - 4 - text_width(y_text), static_cast<int>(at_y) - 5, y_text);
  }
  int name_at = x0 + text_width(plot.title) + 24;
  for (std::size_t i = 0; i < plot.series.size(); ++i) {
    const Series& series = plot.series[i];
    const auto place = [&](std::size_t j) {
      return std::pair(x0 + x.part(series.x[j]) * inner_width,
                       y0 - y.part(series.y[j]) * inner_height);
    };
    for (std::size_t j = 1; j < std::min(series.x.size(), series.y.size()); ++j) {
      if (!std::isfinite(series.y[j - 1]) || !std::isfinite(series.y[j])) continue;
      const auto [from_x, from_y] = place(j - 1);
      const auto [to_x, to_y] = place(j);
      canvas.line(from_x, from_y, to_x, to_y, color_of(i));
    }
    canvas.text(name_at, top + 6, series.name, color_of(i));
    name_at += text_width(series.name) + 12;
  }
}

}  // namespace drawing
