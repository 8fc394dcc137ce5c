// SPDX-License-Identifier: Apache-2.0
#include "conformance/harness/hex.hpp"

#include <charconv>
#include <cstdint>
#include <stdexcept>

namespace rr::conformance {
namespace {

int digit(char c) {
  if (c >= '0' && c <= '9') return c - '0';
  if (c >= 'a' && c <= 'f') return c - 'a' + 10;
  return -1;
}

std::byte pair(std::string_view text) {
  const int high = text.size() < 2 ? -1 : digit(text[0]);
  const int low = text.size() < 2 ? -1 : digit(text[1]);
  if (high < 0 || low < 0) throw std::runtime_error("not hex: " + std::string(text.substr(0, 20)));
  return static_cast<std::byte>(high * 16 + low);
}

// `{name}` or `{hh*n}`, without the braces.
void append_placeholder(Bytes& bytes, std::string_view inside, const Blobs& blobs) {
  if (const auto blob = blobs.find(inside); blob != blobs.end()) {
    const Bytes text = bytes_of_text(blob->second);
    bytes.insert(bytes.end(), text.begin(), text.end());
    return;
  }
  const std::size_t star = inside.find('*');
  std::size_t count = 0;
  if (star == 2) {
    const std::string_view digits = inside.substr(3);
    const auto [end, error] = std::from_chars(digits.begin(), digits.end(), count);
    if (error == std::errc{} && end == digits.end()) {
      bytes.insert(bytes.end(), count, pair(inside));
      return;
    }
  }
  throw std::runtime_error("unknown placeholder {" + std::string(inside) + "}");
}

}  // namespace

Bytes bytes_of_hex(std::string_view text, const Blobs& blobs) {
  Bytes bytes;
  bytes.reserve(text.size() / 2);
  while (!text.empty()) {
    if (text.front() == '{') {
      const std::size_t end = text.find('}');
      if (end == std::string_view::npos) throw std::runtime_error("a { without its }");
      append_placeholder(bytes, text.substr(1, end - 1), blobs);
      text.remove_prefix(end + 1);
    } else {
      bytes.push_back(pair(text));
      text.remove_prefix(2);
    }
  }
  return bytes;
}

std::string hex_of_bytes(std::span<const std::byte> bytes) {
  static constexpr char digits[] = "0123456789abcdef";
  std::string text;
  text.reserve(bytes.size() * 2);
  for (const std::byte byte : bytes) {
    text += digits[static_cast<std::size_t>(byte) >> 4];
    text += digits[static_cast<std::size_t>(byte) & 15];
  }
  return text;
}

Bytes bytes_of_text(std::string_view text) {
  const auto* begin = reinterpret_cast<const std::byte*>(text.data());
  return {begin, begin + text.size()};
}

std::string text_of_bytes(std::span<const std::byte> bytes) {
  return {reinterpret_cast<const char*>(bytes.data()), bytes.size()};
}

bool is_utf8(std::string_view text) {
  for (std::size_t at = 0; at < text.size();) {
    const auto lead = static_cast<std::uint8_t>(text[at]);
    const std::size_t length = lead < 0x80             ? 1
                               : (lead & 0xE0) == 0xC0 ? 2
                               : (lead & 0xF0) == 0xE0 ? 3
                               : (lead & 0xF8) == 0xF0 ? 4
                                                       : 0;
    if (length == 0 || length > text.size() - at) return false;
    std::uint32_t code = length == 1 ? lead : lead & (0xFFU >> (length + 1));
    for (std::size_t i = 1; i < length; ++i) {
      const auto next = static_cast<std::uint8_t>(text[at + i]);
      if ((next & 0xC0) != 0x80) return false;
      code = code << 6 | (next & 0x3FU);
    }
    static constexpr std::uint32_t smallest[] = {0, 0, 0x80, 0x800, 0x10000};
    if (code < smallest[length] || code > 0x10FFFF || (code >= 0xD800 && code <= 0xDFFF)) {
      return false;
    }
    at += length;
  }
  return true;
}

}  // namespace rr::conformance
