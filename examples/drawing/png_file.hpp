// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <cstdint>
#include <span>
#include <string>

namespace drawing {

/// Writes a picture of three bytes (red, green, blue) a pixel, rows from the top. Throws
/// std::runtime_error naming the file when it cannot be written.
void write_png(const std::string& path, int width, int height, std::span<const std::uint8_t> rgb);

}  // namespace drawing
