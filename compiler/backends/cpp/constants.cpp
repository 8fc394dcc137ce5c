// SPDX-License-Identifier: Apache-2.0
#include "compiler/backends/cpp/constants.hpp"

#include <set>
#include <utility>
#include <variant>
#include <vector>

#include "compiler/backends/literals.hpp"
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

std::vector<std::string> array_items(const model::Constant& constant) {
  const auto& numbers = std::get<std::vector<model::Number>>(constant.value);
  const auto& written = std::get<ast::ArrayLiteral>(constant.written).items;
  const auto primitive = std::get<Primitive>(constant.type.base);
  std::vector<std::string> items;
  for (std::size_t i = 0; i < numbers.size(); ++i) {
    items.push_back(number_literal(numbers[i], written[i].text, primitive));
  }
  return items;
}

ConstantPartView part_called(const std::string& name, const std::string& margin) {
  ConstantPartView part;
  part.name = name;
  part.margin = margin;
  return part;
}

void add_parts(std::vector<ConstantPartView>& parts, const model::Constant& constant,
               const std::string& name, const std::string& margin, Types& types) {
  ConstantPartView part = part_called(name, margin);
  if (!constant.is_struct) {
    part.in_class = true;
    describe(part, constant, types);
    parts.push_back(std::move(part));
    return;
  }
  const auto& fields = std::get<std::vector<model::StructValueField>>(constant.value);
  (fields.empty() ? part.is_empty : part.opens) = true;
  parts.push_back(std::move(part));
  if (fields.empty()) return;
  std::set<std::string> seen;
  for (const model::StructValueField& field : fields) {
    std::string field_name = identifier(field.field);
    if (field_name == name) field_name += '_';
    if (!seen.insert(field_name).second) continue;  // Q15
    add_parts(parts, *field.constant, field_name, margin + "  ", types);
  }
  parts.push_back(part_called({}, margin));
  parts.back().closes = true;
}

}  // namespace

std::string string_literal(std::string_view text) {
  std::string result = "\"";
  for (const char c : text) append_escaped(result, c);
  return result + '"';
}

void describe(ConstantFacts& facts, const model::Constant& constant, Types& types) {
  if (const auto* text = std::get_if<std::string>(&constant.value)) {
    types.include("<string_view>");
    facts.type = "::std::string_view";
    facts.value = string_literal(*text);
    if (text->find('\0') != std::string::npos) facts.size = std::to_string(text->size());
    return;
  }
  const auto primitive = std::get<Primitive>(constant.type.base);
  facts.type = types.number(primitive);
  if (const auto* number = std::get_if<model::Number>(&constant.value)) {
    facts.value =
        number_literal(*number, std::get<ast::NumberLiteral>(constant.written).text, primitive);
    return;
  }
  types.include("<array>");
  facts.is_array = true;
  facts.items = array_items(constant);
  facts.type = "::std::array<" + facts.type + ", " + std::to_string(facts.items.size()) + ">";
}

std::vector<ConstantPartView> constant_parts(const model::Constant& constant,
                                             const std::string& name, Types& types) {
  std::vector<ConstantPartView> parts;
  add_parts(parts, constant, name, {}, types);
  return parts;
}

}  // namespace robdef::cpp
