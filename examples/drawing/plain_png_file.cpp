// SPDX-License-Identifier: Apache-2.0
// For machines without libpng: the file holds the bytes as they are, in the form of the format that
// is not compressed.
#include <algorithm>
#include <array>
#include <cstddef>
#include <fstream>
#include <stdexcept>
#include <string_view>
#include <vector>

#include "examples/drawing/png_file.hpp"

namespace drawing {
namespace {

using Bytes = std::vector<std::uint8_t>;

void append_big_endian(Bytes& to, std::uint32_t number) {
  for (int shift = 24; shift >= 0; shift -= 8) {
    to.push_back(static_cast<std::uint8_t>(number >> shift));
  }
}

std::uint32_t crc32_of(std::span<const std::uint8_t> bytes) {
  std::uint32_t sum = 0xFFFFFFFF;
  for (const std::uint8_t byte : bytes) {
    sum ^= byte;
    for (int bit = 0; bit < 8; ++bit) sum = (sum >> 1) ^ ((sum & 1) != 0 ? 0xEDB88320 : 0);
  }
  return ~sum;
}

std::uint32_t adler32_of(std::span<const std::uint8_t> bytes) {
  std::uint32_t low = 1;
  std::uint32_t high = 0;
  for (const std::uint8_t byte : bytes) {
    low = (low + byte) % 65521;
    high = (high + low) % 65521;
  }
  return high << 16 | low;
}

/// RFC 1950 and 1951: blocks of 65535 bytes at most, as they are.
Bytes stored(std::span<const std::uint8_t> bytes) {
  constexpr std::size_t most = 65535;
  Bytes result = {0x78, 0x01};
  std::size_t at = 0;
  do {
    const std::size_t size = std::min(bytes.size() - at, most);
    const bool is_last = at + size == bytes.size();
    const auto low = static_cast<std::uint8_t>(size & 0xFF);
    const auto high = static_cast<std::uint8_t>(size >> 8);
    const std::array<std::uint8_t, 5> head = {static_cast<std::uint8_t>(is_last), low, high,
                                              static_cast<std::uint8_t>(~low),
                                              static_cast<std::uint8_t>(~high)};
    result.insert(result.end(), head.begin(), head.end());
    const auto part = bytes.subspan(at, size);
    result.insert(result.end(), part.begin(), part.end());
    at += size;
  } while (at != bytes.size());
  append_big_endian(result, adler32_of(bytes));
  return result;
}

void append_chunk(Bytes& to, std::string_view type, const Bytes& content) {
  append_big_endian(to, static_cast<std::uint32_t>(content.size()));
  const std::size_t begin = to.size();
  to.insert(to.end(), type.begin(), type.end());
  to.insert(to.end(), content.begin(), content.end());
  append_big_endian(to, crc32_of(std::span(to).subspan(begin)));
}

}  // namespace

void write_png(const std::string& path, int width, int height, std::span<const std::uint8_t> rgb) {
  const auto columns = static_cast<std::size_t>(width);
  const auto rows = static_cast<std::size_t>(height);
  // A chunk has a size of 31 bits.
  if (width <= 0 || height <= 0 || columns > 30000 || rows > 20000 ||
      rgb.size() != std::size_t{3} * columns * rows) {
    throw std::runtime_error(path + ": the picture's data does not fit its size");
  }
  Bytes lines;
  for (std::size_t row = 0; row < rows; ++row) {
    lines.push_back(0);  // no filter
    const auto line = rgb.subspan(3 * columns * row, 3 * columns);
    lines.insert(lines.end(), line.begin(), line.end());
  }
  Bytes header;
  append_big_endian(header, static_cast<std::uint32_t>(width));
  append_big_endian(header, static_cast<std::uint32_t>(height));
  header.insert(header.end(), {8, 2, 0, 0, 0});  // 8 bits of red, green, blue
  Bytes file = {0x89, 'P', 'N', 'G', '\r', '\n', 0x1A, '\n'};
  append_chunk(file, "IHDR", header);
  append_chunk(file, "IDAT", stored(lines));
  append_chunk(file, "IEND", {});
  std::ofstream out(path, std::ios::binary);
  out.write(reinterpret_cast<const char*>(file.data()), static_cast<std::streamsize>(file.size()));
  if (!out.flush()) throw std::runtime_error(path + ": cannot be written");
}

}  // namespace drawing
