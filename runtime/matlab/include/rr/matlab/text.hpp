// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <mex.h>

#include <cstdint>
#include <string>
#include <string_view>
#include <vector>

#include "rr/matlab/misfit.hpp"
#include "rr/matlab/numbers.hpp"

/// Texts between the interpreter and C++: UTF-8 on this side. Octave's characters are UTF-8 bytes
/// too, MATLAB's are UTF-16. For the interpreter's thread.
namespace rr::matlab {

namespace text {

inline void append_utf8(std::string& to, std::uint32_t point) {
  const auto put = [&](std::uint32_t byte) { to += static_cast<char>(byte); };
  if (point < 0x80) {
    put(point);
  } else if (point < 0x800) {
    put(0xc0 | point >> 6);
    put(0x80 | (point & 0x3f));
  } else if (point < 0x10000) {
    put(0xe0 | point >> 12);
    put(0x80 | (point >> 6 & 0x3f));
    put(0x80 | (point & 0x3f));
  } else {
    put(0xf0 | point >> 18);
    put(0x80 | (point >> 12 & 0x3f));
    put(0x80 | (point >> 6 & 0x3f));
    put(0x80 | (point & 0x3f));
  }
}

inline constexpr std::uint32_t replacement = 0xfffd;

template <class Unit>
std::string from_utf16(const Unit* units, std::size_t count) {
  std::string utf8;
  for (std::size_t i = 0; i < count; ++i) {
    std::uint32_t point = static_cast<std::uint16_t>(units[i]);
    if (point >= 0xd800 && point < 0xe000) {
      const std::uint32_t low = i + 1 < count ? static_cast<std::uint16_t>(units[i + 1]) : 0;
      const bool is_pair = point < 0xdc00 && low >= 0xdc00 && low < 0xe000;
      point = is_pair ? 0x10000 + ((point - 0xd800) << 10) + (low - 0xdc00) : replacement;
      if (is_pair) ++i;
    }
    append_utf8(utf8, point);
  }
  return utf8;
}

/// Bytes that are no UTF-8 become U+FFFD, one each.
inline std::vector<std::uint16_t> to_utf16(std::string_view utf8) {
  std::vector<std::uint16_t> units;
  for (std::size_t i = 0; i < utf8.size();) {
    const auto byte = [&](std::size_t at) {
      return at < utf8.size() ? static_cast<unsigned char>(utf8[at]) : 0U;
    };
    const std::uint32_t first = byte(i);
    const std::size_t length = first < 0x80 ? 1 : first >> 5 == 6 ? 2 : first >> 4 == 14 ? 3 : 4;
    std::uint32_t point = length == 1 ? first : first & (0x7fU >> length);
    bool is_good = length < 4 || first >> 3 == 30;
    for (std::size_t k = 1; k < length && is_good; ++k) {
      is_good = byte(i + k) >> 6 == 2;
      point = point << 6 | (byte(i + k) & 0x3f);
    }
    constexpr std::uint32_t least[] = {0, 0, 0x80, 0x800, 0x10000};
    is_good = is_good && point >= least[length] && point < 0x110000 && point >> 11 != 0x1b;
    i += is_good ? length : 1;
    if (!is_good) point = replacement;
    if (point >= 0x10000) {
      units.push_back(static_cast<std::uint16_t>(0xd7c0 + (point >> 10)));
      point = 0xdc00 + (point & 0x3ff);
    }
    units.push_back(static_cast<std::uint16_t>(point));
  }
  return units;
}

}  // namespace text

/// A row of characters, or none at all.
inline bool is_text(const mxArray* value) {
  return mxIsChar(value) && (count_of(value) == 0 || (mxGetM(value) == 1 && is_vector(value)));
}

/// Throws Misfit.
inline std::string read_text(const mxArray* value) {
  if (mxIsClass(value, "string")) {  // MATLAB's; Octave has none
    mxArray* given[] = {const_cast<mxArray*>(value)};
    mxArray* chars = nullptr;
    mxArray* const failure = mexCallMATLABWithTrap(1, &chars, 1, given, "char");
    if (failure == nullptr && is_text(chars)) return read_text(chars);
  }
  if (!is_text(value)) throw Misfit("expected string, got " + described(value));
  const std::size_t count = count_of(value);
  if (count == 0) return {};
  const mxChar* const chars = mxGetChars(value);
  if constexpr (sizeof(mxChar) == 1) {
    return {reinterpret_cast<const char*>(chars), count};
  } else {
    return text::from_utf16(chars, count);
  }
}

/// A row of characters; `''` for an empty text.
inline mxArray* make_text(std::string_view utf8) {
  const auto filled = [](std::size_t count, const void* chars) {
    const mwSize dims[] = {count == 0 ? mwSize{0} : mwSize{1}, static_cast<mwSize>(count)};
    mxArray* const array = mxCreateCharArray(2, dims);
    if (count != 0) std::memcpy(mxGetData(array), chars, count * sizeof(mxChar));
    return array;
  };
  if constexpr (sizeof(mxChar) == 1) {
    return filled(utf8.size(), utf8.data());
  } else {
    const std::vector<std::uint16_t> units = text::to_utf16(utf8);
    return filled(units.size(), units.data());
  }
}

}  // namespace rr::matlab
