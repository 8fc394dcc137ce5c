// SPDX-License-Identifier: Apache-2.0
#include "compiler/backends/literals.hpp"

#include <cstddef>
#include <cstdint>
#include <cstdlib>
#include <limits>
#include <variant>

#include "compiler/backends/words.hpp"
#include "compiler/output/escape.hpp"

namespace robdef {
namespace {

using model::Primitive;

std::string floating_literal(std::string written, bool is_single) {
  if (written.starts_with('+')) written.erase(0, 1);
  const double value = std::strtod(written.c_str(), nullptr);
  const bool is_zero = is_single ? static_cast<float>(value) == 0.0F : value == 0.0;
  // Too small for the type: a compiler would warn of it.
  if (is_zero) written = written.starts_with('-') ? "-0.0" : "0.0";
  if (written.find_first_of(".eE") == std::string::npos) written += ".0";
  return written + (is_single ? "F" : "");
}

std::string signed_literal(std::int64_t value, std::string written) {
  if (value == std::numeric_limits<std::int64_t>::min()) return "-9223372036854775807 - 1";
  if (written.starts_with('+')) written.erase(0, 1);
  // A hexadecimal literal may be unsigned, and stays so behind a minus.
  const bool is_negative_hex = written.starts_with("-0x") || written.starts_with("-0X");
  return is_negative_hex && value <= std::numeric_limits<std::int32_t>::min()
             ? std::to_string(value)
             : written;
}

std::string unsigned_literal(std::uint64_t value, std::string written, std::size_t size) {
  if (written.starts_with('+')) written.erase(0, 1);
  if (written.starts_with('-')) {
    if (size < 8) value &= (std::uint64_t{1} << (8 * size)) - 1;
    written = std::to_string(value);
  }
  return value > static_cast<std::uint64_t>(std::numeric_limits<std::int64_t>::max())
             ? written + "U"
             : written;
}

std::uint64_t as_unsigned(const model::Number& number) {
  if (const auto* value = std::get_if<std::uint64_t>(&number)) return *value;
  if (const auto* value = std::get_if<std::int64_t>(&number)) {
    return static_cast<std::uint64_t>(*value);
  }
  return static_cast<std::uint64_t>(std::get<double>(number));
}

}  // namespace

std::string enum_literal(const model::EnumValue& value) {
  if (!value.is_hexadecimal) return std::to_string(value.value);
  if (value.value == std::numeric_limits<std::int32_t>::min()) return std::to_string(value.value);
  constexpr std::string_view digits = "0123456789abcdef";
  std::string result;
  for (auto rest = static_cast<std::uint32_t>(std::abs(value.value)); rest != 0; rest /= 16) {
    result.insert(result.begin(), digits[rest % 16]);
  }
  return (value.value < 0 ? "-0x" : "0x") + (result.empty() ? "0" : result);
}

std::string number_literal(const model::Number& value, std::string_view written,
                           Primitive primitive) {
  switch (primitive) {
    case Primitive::double_:
    case Primitive::single:
      return floating_literal(std::string(written), primitive == Primitive::single);
    case Primitive::uint8:
    case Primitive::uint16:
    case Primitive::uint32:
    case Primitive::uint64:
      return unsigned_literal(as_unsigned(value), std::string(written), model::size_of(primitive));
    default:
      return signed_literal(static_cast<std::int64_t>(as_unsigned(value)), std::string(written));
  }
}

std::string unicode_literal(std::string_view text) {
  constexpr std::string_view digits = "0123456789ABCDEF";
  std::string result = "\"";
  for (std::size_t i = 0; i < text.size(); ++i) {
    // A byte order mark, and the two line ends that the languages know beyond ASCII, are escaped.
    const std::string_view next = text.substr(i, 3);
    if (next == "\xEF\xBB\xBF") {
      result += "\\uFEFF";
      i += 2;
    } else if (next == "\xE2\x80\xA8" || next == "\xE2\x80\xA9") {
      result += next.back() == '\xA8' ? "\\u2028" : "\\u2029";
      i += 2;
    } else if (text.substr(i, 2) == "\xC2\x85") {
      result += "\\u0085";
      ++i;
    } else {
      append_escaped(result, text[i], digits);
    }
  }
  return result + '"';
}

std::vector<std::string> unicode_literal_lines(std::string_view text) {
  std::vector<std::string> lines;
  for (const std::string_view line : lines_of(text)) {
    if (!lines.empty()) lines.back() += " +";
    lines.push_back(unicode_literal(line));
  }
  if (lines.empty()) lines.emplace_back("\"\"");
  return lines;
}

}  // namespace robdef
