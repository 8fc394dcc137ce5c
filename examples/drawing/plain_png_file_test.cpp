// SPDX-License-Identifier: Apache-2.0
// What is written without libpng is read with it.
#include <gtest/gtest.h>
#include <png.h>

#include <cstdint>
#include <cstdio>
#include <filesystem>
#include <stdexcept>
#include <string>
#include <vector>

#include "examples/drawing/png_file.hpp"

namespace drawing {
namespace {

std::string file_name() {
  const std::string test = ::testing::UnitTest::GetInstance()->current_test_info()->name();
  return (std::filesystem::temp_directory_path() / ("robdef_plain_" + test + ".png")).string();
}

std::vector<std::uint8_t> read_png(const std::string& path, int width, int height) {
  png_image image{};
  image.version = PNG_IMAGE_VERSION;
  EXPECT_NE(png_image_begin_read_from_file(&image, path.c_str()), 0) << image.message;
  EXPECT_EQ(image.width, static_cast<png_uint_32>(width));
  EXPECT_EQ(image.height, static_cast<png_uint_32>(height));
  EXPECT_EQ(image.format, static_cast<png_uint_32>(PNG_FORMAT_RGB));
  std::vector<std::uint8_t> rgb(PNG_IMAGE_SIZE(image));
  EXPECT_NE(png_image_finish_read(&image, nullptr, rgb.data(), 0, nullptr), 0) << image.message;
  return rgb;
}

// The second one does not fit into one block, nor into two.
TEST(PlainPictures, AreReadByLibpng) {
  for (const auto& [width, height] : {std::pair{1, 1}, std::pair{317, 201}}) {
    std::vector<std::uint8_t> rgb(static_cast<std::size_t>(3 * width * height));
    std::uint32_t next = 1;
    for (std::uint8_t& byte : rgb) {
      next = next * 1664525 + 1013904223;
      byte = static_cast<std::uint8_t>(next >> 24);
    }
    write_png(file_name(), width, height, rgb);
    EXPECT_EQ(read_png(file_name(), width, height), rgb);
  }
  std::filesystem::remove(file_name());
}

TEST(PlainPictures, ThatDoNotFitTheirSizeAreRefused) {
  const std::vector<std::uint8_t> rgb(12);
  EXPECT_THROW(write_png(file_name(), 2, 1, rgb), std::runtime_error);
  EXPECT_THROW(write_png(file_name(), 0, 0, {}), std::runtime_error);
  EXPECT_THROW(write_png(file_name(), -2, -2, rgb), std::runtime_error);
  EXPECT_THROW(write_png("/no_such_folder/picture.png", 2, 2, rgb), std::runtime_error);
}

}  // namespace
}  // namespace drawing
