// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <bit>
#include <cstddef>
#include <cstdint>
#include <cstring>
#include <span>
#include <string_view>

namespace rr::codec {

static_assert(std::endian::native == std::endian::little, "the wire is little-endian");

/// Reads fields from borrowed bytes. Every function returns false, and reads nothing, when the
/// field does not lie before the end.
struct Cursor {
  const std::byte* at;
  const std::byte* end;

  [[nodiscard]] std::size_t left() const { return static_cast<std::size_t>(end - at); }

  /// An integer of fixed width.
  template <class T>
  bool number(T& value) {
    if (left() < sizeof value) return false;
    std::memcpy(&value, at, sizeof value);
    at += sizeof value;
    return true;
  }

  bool bytes(std::size_t size, std::span<const std::byte>& value) {
    if (left() < size) return false;
    value = {at, size};
    at += size;
    return true;
  }
  bool text(std::size_t size, std::string_view& value) {
    if (left() < size) return false;
    value = {reinterpret_cast<const char*>(at), size};
    at += size;
    return true;
  }

  /// A text after its u16 length (01, section 1).
  bool string16(std::string_view& value) {
    std::uint16_t size = 0;
    return number(size) && text(size, value);
  }

  /// 02, section 1.1. Longer forms of small values are taken, as the reference's streaming reader
  /// takes them; the nine byte form is refused.
  bool uint_x(std::uint32_t& value) {
    if (at == end) return false;
    const auto first = std::to_integer<std::uint8_t>(*at);
    if (first < 253) [[likely]] {
      value = first;
      ++at;
      return true;
    }
    return long_uint_x(first, value);
  }
  /// 02, section 1.2.
  bool int_x(std::int32_t& value) {
    if (at == end) return false;
    const auto first = std::to_integer<std::uint8_t>(*at);
    if (first < 125 || first > 127) [[likely]] {
      value = static_cast<std::int8_t>(first);  // NOLINT(bugprone-signed-char-misuse)
      ++at;
      return true;
    }
    return long_int_x(first, value);
  }
  /// A text after its uint_x length (02, section 1.4).
  bool xstring(std::string_view& value) {
    std::uint32_t size = 0;
    return uint_x(size) && text(size, value);
  }
  bool xbytes(std::span<const std::byte>& value) {
    std::uint32_t size = 0;
    return uint_x(size) && bytes(size, value);
  }

 private:
  bool long_uint_x(std::uint8_t first, std::uint32_t& value) {
    const std::size_t size = first == 253 ? 2 : 4;
    if (first == 255 || left() < 1 + size) return false;
    value = 0;
    std::memcpy(&value, at + 1, size);
    at += 1 + size;
    return true;
  }
  bool long_int_x(std::uint8_t first, std::int32_t& value) {
    if (first == 127 || left() < (first == 125 ? 3U : 5U)) return false;
    if (first == 125) {
      std::int16_t narrow = 0;
      std::memcpy(&narrow, at + 1, sizeof narrow);
      value = narrow;
      at += 3;
    } else {
      std::memcpy(&value, at + 1, sizeof value);
      at += 5;
    }
    return true;
  }
};

}  // namespace rr::codec
