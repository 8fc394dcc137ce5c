// SPDX-License-Identifier: Apache-2.0
#include "compiler/backends/cpp/constants.hpp"

#include <algorithm>
#include <set>
#include <variant>
#include <vector>

#include "compiler/backends/literals.hpp"
#include "compiler/backends/words.hpp"
#include "compiler/output/cpp_layout.hpp"
#include "compiler/output/escape.hpp"

namespace robdef::cpp {
namespace {

using model::Primitive;

void append_escaped(std::string& out, char c) {
  const std::string_view escape = named_escape(c);
  if (!escape.empty()) {
    out += escape;
  } else if (c == '?' && out.ends_with('?')) {  // two of them begin a trigraph
    out += "\\?";
  } else if (is_printable(c)) {
    out += c;
  } else {
    const auto byte = static_cast<unsigned char>(c);
    out += '\\';
    for (const int shift : {6, 3, 0}) out += static_cast<char>('0' + ((byte >> shift) & 7));
  }
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
