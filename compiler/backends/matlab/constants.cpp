// SPDX-License-Identifier: Apache-2.0
#include "compiler/backends/matlab/constants.hpp"

#include <cstdint>
#include <cstdlib>
#include <set>
#include <variant>
#include <vector>

#include "compiler/backends/words.hpp"

namespace robdef::matlab {
namespace {

using model::Number;
using model::Primitive;

// Larger ones are rounded: a literal is a double before it is anything else.
constexpr std::uint64_t exact_in_double = std::uint64_t{1} << 53;

std::string wide_bits(std::uint64_t bits) {
  return "bitor(bitshift(uint64(" + std::to_string(bits >> 32) + "), 32), uint64(" +
         std::to_string(bits & 0xFFFFFFFF) + "))";
}

/// Whether it is exact behind a conversion, as in `int64(5)`.
bool is_plain(const Number& value) {
  if (const auto* number = std::get_if<std::int64_t>(&value)) {
    const auto limit = static_cast<std::int64_t>(exact_in_double);
    return *number <= limit && *number >= -limit;
  }
  const auto* number = std::get_if<std::uint64_t>(&value);
  return number == nullptr || *number <= exact_in_double;
}

std::string floating(std::string_view written, bool is_single) {
  std::string text(written);
  if (text.starts_with('+')) text.erase(0, 1);
  const double value = std::strtod(text.c_str(), nullptr);
  const bool is_zero = is_single ? static_cast<float>(value) == 0.0F : value == 0.0;
  return is_zero && !text.starts_with('-') ? "0" : text;
}

std::string plain_number(const Number& value, std::string_view written, Primitive primitive) {
  if (primitive == Primitive::double_ || primitive == Primitive::single) {
    return floating(written, primitive == Primitive::single);
  }
  if (const auto* number = std::get_if<std::int64_t>(&value)) return std::to_string(*number);
  if (const auto* number = std::get_if<std::uint64_t>(&value)) {
    // A negative literal of an unsigned type wraps (Q13) within its own size.
    const std::size_t size = model::size_of(primitive);
    const std::uint64_t mask = size < 8 ? (std::uint64_t{1} << (8 * size)) - 1 : ~std::uint64_t{0};
    return std::to_string(*number & mask);
  }
  return floating(written, false);
}

std::string scalar(const Number& value, std::string_view written, Primitive primitive) {
  if (!is_plain(value)) {
    if (const auto* number = std::get_if<std::int64_t>(&value)) {
      return "typecast(" + wide_bits(static_cast<std::uint64_t>(*number)) + ", 'int64')";
    }
    const std::uint64_t bits = std::get<std::uint64_t>(value);
    if (model::size_of(primitive) == 8) return wide_bits(bits);
  }
  std::string number = plain_number(value, written, primitive);
  if (primitive == Primitive::double_) return number;
  return std::string(model::name_of(primitive)) + "(" + number + ")";
}

std::string array(const model::Constant& constant, Primitive primitive) {
  const auto& numbers = std::get<std::vector<Number>>(constant.value);
  const auto& written = std::get<ast::ArrayLiteral>(constant.written).items;
  const std::string type(model::name_of(primitive));
  if (numbers.empty()) {
    return primitive == Primitive::double_ ? "zeros(0, 1)" : "zeros(0, 1, '" + type + "')";
  }
  bool are_plain = true;
  for (const Number& number : numbers) are_plain = are_plain && is_plain(number);
  std::vector<std::string> items;
  for (std::size_t i = 0; i < numbers.size(); ++i) {
    items.push_back(are_plain ? plain_number(numbers[i], written[i].text, primitive)
                              : scalar(numbers[i], written[i].text, primitive));
  }
  const std::string column = "[" + join(items, "; ") + "]";
  return are_plain && primitive != Primitive::double_ ? type + "(" + column + ")" : column;
}

std::string struct_value(const model::Constant& constant) {
  std::vector<std::string> items;
  std::set<std::string> seen;
  for (const auto& field : std::get<std::vector<model::StructValueField>>(constant.value)) {
    if (!seen.insert(field.field).second) continue;  // Q15
    items.push_back("'" + field.field + "', " + constant_value(*field.constant));
  }
  return "struct(" + join(items, ", ") + ")";
}

}  // namespace

std::string string_literal(std::string_view text) {
  std::vector<std::string> pieces;
  std::string run;
  const auto finish = [&] {
    if (!run.empty()) pieces.push_back("'" + run + "'");
    run.clear();
  };
  for (const char c : text) {
    const auto byte = static_cast<unsigned char>(c);
    if (byte < 0x20 || byte == 0x7F) {
      finish();
      pieces.push_back("char(" + std::to_string(byte) + ")");
    } else {
      run += c;
      if (c == '\'') run += c;
    }
  }
  finish();
  if (pieces.empty()) return "''";

  return pieces.size() == 1 ? pieces.front() : "[" + join(pieces, " ") + "]";
}

std::string constant_value(const model::Constant& constant) {
  if (constant.is_struct) return struct_value(constant);
  if (const auto* text = std::get_if<std::string>(&constant.value)) return string_literal(*text);
  const auto primitive = std::get<Primitive>(constant.type.base);
  if (std::holds_alternative<std::vector<Number>>(constant.value)) {
    return array(constant, primitive);
  }
  return scalar(std::get<Number>(constant.value),
                std::get<ast::NumberLiteral>(constant.written).text, primitive);
}

}  // namespace robdef::matlab
