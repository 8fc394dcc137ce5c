// SPDX-License-Identifier: Apache-2.0
#include "compiler/syntax/literals.hpp"

#include <algorithm>
#include <charconv>
#include <system_error>

#include "compiler/syntax/words.hpp"

namespace robdef::syntax {
namespace {

constexpr std::size_t unicode_escape_length = 6;  // \u and four digits

int digit_value(char c) {
  if (is_digit(c)) return c - '0';
  if (c >= 'a' && c <= 'f') return c - 'a' + 10;
  if (c >= 'A' && c <= 'F') return c - 'A' + 10;
  return -1;
}

// The unit of a `\uXXXX` at the start of the text, or -1.
std::int32_t unicode_escape(std::string_view text) {
  if (text.size() < unicode_escape_length || !text.starts_with("\\u")) return -1;
  std::int32_t unit = 0;
  for (const char c : text.substr(2, 4)) {
    const int value = digit_value(c);
    if (value < 0) return -1;
    unit = unit * 16 + value;
  }
  return unit;
}

constexpr bool is_high_surrogate(std::int32_t unit) { return unit >= 0xD800 && unit < 0xDC00; }
constexpr bool is_low_surrogate(std::int32_t unit) { return unit >= 0xDC00 && unit < 0xE000; }

void append_utf8(std::string& text, std::uint32_t point) {
  const auto put = [&text](std::uint32_t byte) { text += static_cast<char>(byte); };
  if (point < 0x80) {
    put(point);
  } else if (point < 0x800) {
    put(0xC0 | point >> 6);
    put(0x80 | (point & 0x3F));
  } else if (point < 0x10000) {
    put(0xE0 | point >> 12);
    put(0x80 | (point >> 6 & 0x3F));
    put(0x80 | (point & 0x3F));
  } else {
    put(0xF0 | point >> 18);
    put(0x80 | (point >> 12 & 0x3F));
    put(0x80 | (point >> 6 & 0x3F));
    put(0x80 | (point & 0x3F));
  }
}

char simple_escape(char c) {
  switch (c) {
    case 'b':
      return '\b';
    case 'f':
      return '\f';
    case 'n':
      return '\n';
    case 'r':
      return '\r';
    case 't':
      return '\t';
    default:
      return c;
  }
}

// from_chars does not say which way a number is out of range. The power of ten of its first digit
// that is not zero does.
bool is_below_one(std::string_view text) {
  const std::size_t exponent_at = std::min(text.find_first_of("eE"), text.size());
  const std::string_view mantissa = text.substr(0, exponent_at);
  const std::size_t point = std::min(mantissa.find('.'), mantissa.size());
  const std::size_t first = mantissa.find_first_of("123456789");
  std::int64_t power = static_cast<std::int64_t>(point) - static_cast<std::int64_t>(first);
  std::string_view exponent = text.substr(std::min(exponent_at + 1, text.size()));
  const bool is_negative = exponent.starts_with('-');
  if (is_negative || exponent.starts_with('+')) exponent.remove_prefix(1);
  std::int64_t value = 0;
  const auto read = std::from_chars(exponent.data(), exponent.data() + exponent.size(), value);
  if (read.ec == std::errc::result_out_of_range) return is_negative;
  return power + (is_negative ? -value : value) <= 0;
}

template <class Number>
FloatFit fit_as(std::string_view text) {
  Number number{};
  const auto read = std::from_chars(text.data(), text.data() + text.size(), number);
  if (read.ec != std::errc::result_out_of_range) return FloatFit::fits;
  return is_below_one(text) ? FloatFit::underflows : FloatFit::overflows;
}

}  // namespace

Integer read_integer(std::string_view text) {
  Integer integer;
  integer.is_negative = text.starts_with('-');
  if (integer.is_negative || text.starts_with('+')) text.remove_prefix(1);
  integer.is_hexadecimal = text.starts_with("0x");
  if (integer.is_hexadecimal) text.remove_prefix(2);
  const auto read = std::from_chars(text.data(), text.data() + text.size(), integer.magnitude,
                                    integer.is_hexadecimal ? 16 : 10);
  integer.is_too_large = read.ec == std::errc::result_out_of_range;
  return integer;
}

bool fits(const Integer& integer, bool is_signed, int bits) {
  if (integer.is_too_large) return false;
  const std::uint64_t largest = ~std::uint64_t{0} >> (64 - bits);
  if (!is_signed) return integer.magnitude <= largest;
  return integer.magnitude <= (largest >> 1) + (integer.is_negative ? 1 : 0);
}

FloatFit fit_float(std::string_view text, bool is_single) {
  if (text.starts_with('-') || text.starts_with('+')) text.remove_prefix(1);
  return is_single ? fit_as<float>(text) : fit_as<double>(text);
}

StringFault find_string_fault(std::string_view text) {
  for (std::size_t at = 1; at < text.size(); ++at) {
    if (text[at] == '"') break;
    if (text[at] != '\\') continue;
    const bool is_unicode = at + 1 < text.size() && text[at + 1] == 'u';
    if (is_unicode && unicode_escape(text.substr(at)) >= 0) {
      at += unicode_escape_length - 1;
    } else if (at + 1 < text.size() && !is_unicode &&
               std::string_view("\"\\/bfnrt").find(text[at + 1]) != std::string_view::npos) {
      ++at;
    } else {
      return {false, at, std::min(at + 2, text.size())};
    }
  }
  return {true, 0, 1};
}

std::optional<std::string> read_string(std::string_view text, StringFault& fault) {
  std::string value;
  const std::size_t end = text.size() - 1;
  for (std::size_t at = 1; at < end; ++at) {
    if (text[at] != '\\') {
      value += text[at];
      continue;
    }
    if (text[at + 1] != 'u') {
      value += simple_escape(text[++at]);
      continue;
    }
    const std::int32_t unit = unicode_escape(text.substr(at));
    auto point = static_cast<std::uint32_t>(unit);
    if (is_high_surrogate(unit)) {
      const std::int32_t low = unicode_escape(text.substr(at + unicode_escape_length));
      if (is_low_surrogate(low)) {
        point = 0x10000 + ((point - 0xD800) << 10) + (static_cast<std::uint32_t>(low) - 0xDC00);
        at += unicode_escape_length;
      }
    }
    if (point >= 0xD800 && point < 0xE000) {
      fault = {false, at, at + unicode_escape_length};
      return std::nullopt;
    }
    append_utf8(value, point);
    at += unicode_escape_length - 1;
  }
  return value;
}

}  // namespace robdef::syntax
