// SPDX-License-Identifier: Apache-2.0
#include "compiler/backends/cpp/constants.hpp"

#include <algorithm>
#include <cstdint>
#include <cstdlib>
#include <limits>
#include <set>
#include <variant>
#include <vector>

#include "compiler/backends/cpp/layout.hpp"
#include "compiler/backends/words.hpp"

namespace robdef::cpp {
namespace {

using model::Primitive;

std::string blanks(std::size_t count) { return std::string(count, ' '); }

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

void append_escaped(std::string& out, char c) {
  switch (c) {
    case '"':
      out += "\\\"";
      return;
    case '\\':
      out += "\\\\";
      return;
    case '\n':
      out += "\\n";
      return;
    case '\r':
      out += "\\r";
      return;
    case '\t':
      out += "\\t";
      return;
    case '?':  // two of them begin a trigraph
      out += out.ends_with('?') ? "\\?" : "?";
      return;
    default:
      break;
  }
  const auto byte = static_cast<unsigned char>(c);
  if (byte >= 0x20 && byte != 0x7F) {
    out += c;
    return;
  }
  out += '\\';
  for (const int shift : {6, 3, 0}) out += static_cast<char>('0' + ((byte >> shift) & 7));
}

std::string array_value(const model::Constant& constant) {
  const auto& numbers = std::get<std::vector<model::Number>>(constant.value);
  const auto& written = std::get<ast::ArrayLiteral>(constant.written).items;
  const auto primitive = std::get<Primitive>(constant.type.base);
  std::vector<std::string> items;
  for (std::size_t i = 0; i < numbers.size(); ++i) {
    items.push_back(number_literal(numbers[i], written[i].text, primitive));
  }
  return join(items, ", ");
}

std::string array_definition(const model::Constant& constant, const std::string& left,
                             std::size_t indent) {
  List list{.before = left + " = {", .items = {}, .after = "};"};
  const auto& numbers = std::get<std::vector<model::Number>>(constant.value);
  const auto& written = std::get<ast::ArrayLiteral>(constant.written).items;
  for (std::size_t i = 0; i < numbers.size(); ++i) {
    list.items.push_back(
        number_literal(numbers[i], written[i].text, std::get<Primitive>(constant.type.base)));
  }
  return braced_list(list, indent);
}

std::string struct_definition(const model::Constant& constant, const std::string& name,
                              Types& types, std::size_t indent) {
  const auto& fields = std::get<std::vector<model::StructValueField>>(constant.value);
  if (fields.empty()) return "struct " + name + " {};";
  std::string result = "struct " + name + " {";
  std::set<std::string> seen;
  for (const model::StructValueField& field : fields) {
    std::string field_name = identifier(field.field);
    if (field_name == name) field_name += '_';
    if (!seen.insert(field_name).second) continue;  // Q15
    result +=
        "\n" + blanks(indent + 2) +
        constant_definition(*field.constant, field_name, "static constexpr", types, indent + 2);
  }
  return result + "\n" + blanks(indent) + "};";
}

}  // namespace

std::string string_literal(std::string_view text) {
  std::string result = "\"";
  for (const char c : text) append_escaped(result, c);
  return result + '"';
}

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

std::string constant_type(const model::Constant& constant, Types& types) {
  if (constant.is_struct) return "";
  if (std::holds_alternative<std::string>(constant.value)) {
    types.include("<string_view>");
    return "::std::string_view";
  }
  const std::string number = types.number(std::get<Primitive>(constant.type.base));
  const auto* numbers = std::get_if<std::vector<model::Number>>(&constant.value);
  if (numbers == nullptr) return number;
  types.include("<array>");
  return "::std::array<" + number + ", " + std::to_string(numbers->size()) + ">";
}

std::string constant_value(const model::Constant& constant) {
  if (constant.is_struct) return "";
  if (const auto* text = std::get_if<std::string>(&constant.value)) {
    const std::string literal = string_literal(*text);
    if (text->find('\0') == std::string::npos) return literal;
    return "{" + literal + ", " + std::to_string(text->size()) + "}";
  }
  if (std::holds_alternative<std::vector<model::Number>>(constant.value)) {
    return "{" + array_value(constant) + "}";
  }
  return number_literal(std::get<model::Number>(constant.value),
                        std::get<ast::NumberLiteral>(constant.written).text,
                        std::get<Primitive>(constant.type.base));
}

std::string constant_definition(const model::Constant& constant, const std::string& name,
                                std::string_view storage, Types& types, std::size_t indent) {
  if (constant.is_struct) return struct_definition(constant, name, types, indent);
  const std::string left = std::string(storage) + " " + constant_type(constant, types) + " " + name;
  if (std::holds_alternative<std::vector<model::Number>>(constant.value)) {
    return array_definition(constant, left, indent);
  }
  return assignment(left, constant_value(constant), indent);
}

}  // namespace robdef::cpp
