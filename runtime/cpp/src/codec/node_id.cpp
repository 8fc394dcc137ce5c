// SPDX-License-Identifier: Apache-2.0
#include "rr/node_id.hpp"

#include <cstring>
#include <span>

#include "runtime/cpp/src/platform/random.hpp"

namespace rr {
namespace {

// Index of the first text character of each byte, hyphens left out.
constexpr std::array<std::uint8_t, 16> text_position = {0,  2,  4,  6,  9,  11, 14, 16,
                                                        19, 21, 24, 26, 28, 30, 32, 34};
constexpr std::size_t text_size = 36;

constexpr int hex_digit(char c) {
  if (c >= '0' && c <= '9') return c - '0';
  if (c >= 'a' && c <= 'f') return c - 'a' + 10;
  if (c >= 'A' && c <= 'F') return c - 'A' + 10;
  return -1;
}

void write_text(const NodeId& id, char* to) {
  constexpr std::string_view digits = "0123456789abcdef";
  to[8] = to[13] = to[18] = to[23] = '-';
  for (std::size_t i = 0; i < text_position.size(); ++i) {
    to[text_position[i]] = digits[id.bytes[i] >> 4U];
    to[text_position[i] + 1U] = digits[id.bytes[i] & 0x0FU];
  }
}

}  // namespace

NodeId NodeId::random() {
  NodeId id;
  platform::fill_random(std::as_writable_bytes(std::span(id.bytes)));
  id.bytes[6] = static_cast<std::uint8_t>((id.bytes[6] & 0x0FU) | 0x40U);  // version 4
  id.bytes[8] = static_cast<std::uint8_t>((id.bytes[8] & 0x3FU) | 0x80U);  // RFC 4122 variant
  return id;
}

std::optional<NodeId> NodeId::parse(std::string_view text) {
  if (text.size() == text_size + 2 && text.front() == '{' && text.back() == '}') {
    text = text.substr(1, text_size);
  }
  if (text.size() != text_size) return std::nullopt;
  if (text[8] != '-' || text[13] != '-' || text[18] != '-' || text[23] != '-') return std::nullopt;
  NodeId id;
  for (std::size_t i = 0; i < text_position.size(); ++i) {
    const int high = hex_digit(text[text_position[i]]);
    const int low = hex_digit(text[text_position[i] + 1U]);
    if (high < 0 || low < 0) return std::nullopt;
    id.bytes[i] = static_cast<std::uint8_t>(high * 16 + low);
  }
  return id;
}

std::string NodeId::text() const {
  std::string result(text_size, '\0');
  write_text(*this, result.data());
  return result;
}

std::string NodeId::text_with_braces() const {
  std::string result(text_size + 2, '\0');
  result.front() = '{';
  write_text(*this, result.data() + 1);
  result.back() = '}';
  return result;
}

}  // namespace rr
