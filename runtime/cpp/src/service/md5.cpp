// SPDX-License-Identifier: Apache-2.0
#include "runtime/cpp/src/service/md5.hpp"

#include <array>
#include <bit>
#include <cmath>
#include <cstdint>

namespace rr::service {
namespace {

using State = std::array<std::uint32_t, 4>;

constexpr std::size_t block_size = 64;
constexpr int rotations[4][4] = {{7, 12, 17, 22}, {5, 9, 14, 20}, {4, 11, 16, 23}, {6, 10, 15, 21}};

std::uint32_t word_at(const char* bytes) {
  std::uint32_t word = 0;
  for (std::size_t i = 4; i-- != 0;) word = word << 8 | static_cast<unsigned char>(bytes[i]);
  return word;
}

// The standard gives these as the sines of whole numbers.
std::uint32_t constant(unsigned step) {
  return static_cast<std::uint32_t>(std::floor(std::fabs(std::sin(step + 1.0)) * 4294967296.0));
}

void add_block(State& state, const char* block) {
  auto [a, b, c, d] = state;
  for (unsigned step = 0; step < block_size; ++step) {
    std::uint32_t mixed = 0;
    unsigned word = 0;
    switch (step / 16) {
      case 0:
        mixed = (b & c) | (~b & d);
        word = step;
        break;
      case 1:
        mixed = (d & b) | (~d & c);
        word = 5 * step + 1;
        break;
      case 2:
        mixed = b ^ c ^ d;
        word = 3 * step + 5;
        break;
      default:
        mixed = c ^ (b | ~d);
        word = 7 * step;
        break;
    }
    const std::uint32_t sum = a + mixed + constant(step) + word_at(block + 4 * (word % 16));
    a = d;
    d = c;
    c = b;
    b += std::rotl(sum, rotations[step / 16][step % 4]);
  }
  state[0] += a;
  state[1] += b;
  state[2] += c;
  state[3] += d;
}

}  // namespace

std::string md5(std::string_view text) {
  std::string padded(text);
  padded.push_back('\x80');
  while (padded.size() % block_size != block_size - 8) padded.push_back('\0');
  const std::uint64_t bits = std::uint64_t{text.size()} * 8;
  for (int i = 0; i < 8; ++i) padded.push_back(static_cast<char>(bits >> (8 * i) & 0xFF));

  State state = {0x67452301, 0xefcdab89, 0x98badcfe, 0x10325476};
  for (std::size_t i = 0; i < padded.size(); i += block_size) add_block(state, padded.data() + i);

  constexpr std::string_view digits = "0123456789abcdef";
  std::string result;
  for (const std::uint32_t word : state) {
    for (unsigned i = 0; i < 4; ++i) {
      const std::uint32_t byte = word >> (8 * i) & 0xFF;
      result.push_back(digits[byte / 16]);
      result.push_back(digits[byte % 16]);
    }
  }
  return result;
}

}  // namespace rr::service
