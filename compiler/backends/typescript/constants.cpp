// SPDX-License-Identifier: Apache-2.0
#include "compiler/backends/typescript/constants.hpp"

#include <set>
#include <variant>
#include <vector>

#include "compiler/backends/literals.hpp"
#include "compiler/backends/words.hpp"

namespace robdef::typescript {
namespace {

using model::Primitive;

bool is_big(Primitive primitive) {
  return primitive == Primitive::int64 || primitive == Primitive::uint64;
}

/// JavaScript reads no zeros before other digits.
std::string without_zeros(std::string text) {
  const std::size_t at = text.starts_with('-') ? 1 : 0;
  while (at + 1 < text.size() && text[at] == '0' && text[at + 1] >= '0' && text[at + 1] <= '9') {
    text.erase(at, 1);
  }
  return text;
}

std::string integer(const model::Number& value, std::string_view written, Primitive primitive) {
  const bool is_hexadecimal = written.starts_with("0x") || written.starts_with("0X");
  std::string text = is_hexadecimal
                         ? "0x" + std::string(written.substr(2))
                         : std::visit([](auto number) { return std::to_string(number); }, value);
  return is_big(primitive) ? text + "n" : text;
}

/// A negative number of an unsigned type wraps (Q13).
model::Number wrapped(const model::Number& value, Primitive primitive) {
  const auto* number = std::get_if<std::int64_t>(&value);
  if (number == nullptr || *number >= 0) return value;
  const auto bits = static_cast<std::uint64_t>(*number);
  switch (primitive) {
    case Primitive::uint8:
    case Primitive::uint16:
    case Primitive::uint32:
      return bits & ((std::uint64_t{1} << (8 * model::size_of(primitive))) - 1);
    case Primitive::uint64:
      return bits;
    default:
      return value;
  }
}

std::string number(const model::Constant& constant, const model::Number& value,
                   const std::string& written) {
  const Primitive primitive = std::get<Primitive>(constant.type.base);
  const bool is_floating = primitive == Primitive::double_ || primitive == Primitive::single;
  if (is_floating) return without_zeros(number_literal(value, written, Primitive::double_));
  return integer(wrapped(value, primitive), written, primitive);
}

std::string array(const model::Constant& constant, const std::vector<model::Number>& numbers) {
  const auto& written = std::get<ast::ArrayLiteral>(constant.written).items;
  std::vector<std::string> items;
  for (std::size_t i = 0; i < numbers.size(); ++i) {
    items.push_back(number(constant, numbers[i], written[i].text));
  }
  return "[" + join(items, ", ") + "]";
}

std::string object(const model::Constant& constant, std::size_t indent) {
  const std::string blanks(indent, ' ');
  std::string result = "{";
  std::set<std::string> seen;
  for (const auto& field : std::get<std::vector<model::StructValueField>>(constant.value)) {
    if (!seen.insert(field.field).second) continue;  // Q15
    result += "\n" + blanks + "  " + field.field + ": " +
              constant_value(*field.constant, indent + 2) + ",";
  }
  return seen.empty() ? "{}" : result + "\n" + blanks + "}";
}

}  // namespace

std::string constant_value(const model::Constant& constant, std::size_t indent) {
  if (constant.is_struct) return object(constant, indent);
  if (const auto* text = std::get_if<std::string>(&constant.value)) return unicode_literal(*text);
  if (const auto* numbers = std::get_if<std::vector<model::Number>>(&constant.value)) {
    return array(constant, *numbers);
  }
  const auto& written = std::get<ast::NumberLiteral>(constant.written).text;
  return number(constant, std::get<model::Number>(constant.value), written);
}

std::string constant_definition(const model::Constant& constant, const std::string& name) {
  const std::string value = constant_value(constant, 0);
  if (constant.is_struct) return name + " = " + value + " as const";
  if (!std::holds_alternative<std::vector<model::Number>>(constant.value)) {
    return name + " = " + value;
  }
  const bool has_big = is_big(std::get<Primitive>(constant.type.base));
  return name + ": readonly " + (has_big ? "bigint" : "number") + "[] = " + value;
}

}  // namespace robdef::typescript
