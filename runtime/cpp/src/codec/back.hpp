// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <cstddef>
#include <cstdint>
#include <cstring>
#include <span>
#include <string_view>

namespace rr::codec {

/// Longest forms of a field whose length varies.
inline constexpr std::size_t longest_uint_x = 5;

/// Copies up to 16 bytes without a call: names are short, and a call costs more than the copy.
inline void copy_short(std::byte* to, const void* from, std::size_t size) {
  const auto* source = static_cast<const std::byte*>(from);
  if (size > 16) {
    std::memcpy(to, source, size);
  } else if (size >= 8) {
    std::uint64_t first = 0;
    std::uint64_t last = 0;
    std::memcpy(&first, source, 8);
    std::memcpy(&last, source + size - 8, 8);
    std::memcpy(to, &first, 8);
    std::memcpy(to + size - 8, &last, 8);
  } else if (size >= 4) {
    std::uint32_t first = 0;
    std::uint32_t last = 0;
    std::memcpy(&first, source, 4);
    std::memcpy(&last, source + size - 4, 4);
    std::memcpy(to, &first, 4);
    std::memcpy(to + size - 4, &last, 4);
  } else if (size != 0) {
    to[0] = source[0];
    to[size / 2] = source[size / 2];
    to[size - 1] = source[size - 1];
  }
}

/// Writes fields backwards into room that has been reserved: each call puts its field in front of
/// the one before.
struct Back {
  std::byte* at;

  template <class T>
  void number(T value) {
    at -= sizeof value;
    std::memcpy(at, &value, sizeof value);
  }
  void u8(std::uint8_t value) { *--at = std::byte{value}; }
  void bytes(const void* data, std::size_t size) {
    at -= size;
    copy_short(at, data, size);
  }

  /// Always the shortest form (02, section 1.1).
  void uint_x(std::uint32_t value) {
    if (value < 253) [[likely]] {
      u8(static_cast<std::uint8_t>(value));
    } else if (value <= 0xFFFF) {
      number(static_cast<std::uint16_t>(value));
      u8(253);
    } else {
      number(value);
      u8(254);
    }
  }
  /// 02, section 1.2.
  void int_x(std::int32_t value) {
    if (value >= -128 && value <= 124) [[likely]] {
      u8(static_cast<std::uint8_t>(value));
    } else if (value >= -32768 && value <= 32767) {
      number(static_cast<std::int16_t>(value));
      u8(125);
    } else {
      number(value);
      u8(126);
    }
  }
  /// A size that counts its own bytes too; `others` are the bytes behind it (02, section 1.3).
  void own_size(std::uint32_t others) {
    const std::uint32_t own = others < 252 ? 1 : others < 65533 ? 3 : 5;
    uint_x(others + own);
  }

  void string16(std::string_view text) {
    bytes(text.data(), text.size());
    number(static_cast<std::uint16_t>(text.size()));
  }
  void xstring(std::string_view text) {
    bytes(text.data(), text.size());
    uint_x(static_cast<std::uint32_t>(text.size()));
  }
  void xbytes(std::span<const std::byte> data) {
    bytes(data.data(), data.size());
    uint_x(static_cast<std::uint32_t>(data.size()));
  }
};

}  // namespace rr::codec
