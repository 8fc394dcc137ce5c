// SPDX-License-Identifier: Apache-2.0
#include "examples/drawing/png_file.hpp"

#include <png.h>

#include <cstddef>
#include <stdexcept>

namespace drawing {

void write_png(const std::string& path, int width, int height, std::span<const std::uint8_t> rgb) {
  if (width <= 0 || height <= 0 ||
      rgb.size() !=
          std::size_t{3} * static_cast<std::size_t>(width) * static_cast<std::size_t>(height)) {
    throw std::runtime_error(path + ": the picture's data does not fit its size");
  }
  png_image image{};
  image.version = PNG_IMAGE_VERSION;
  image.width = static_cast<png_uint_32>(width);
  image.height = static_cast<png_uint_32>(height);
  image.format = PNG_FORMAT_RGB;
  if (png_image_write_to_file(&image, path.c_str(), 0, rgb.data(), 0, nullptr) == 0) {
    throw std::runtime_error(path + ": " + image.message);
  }
}

}  // namespace drawing
