// SPDX-License-Identifier: Apache-2.0
#include "compiler/backends/csharp/constants.hpp"

#include <set>
#include <variant>
#include <vector>

#include "compiler/backends/literals.hpp"
#include "compiler/backends/words.hpp"

namespace robdef::csharp {
namespace {

using model::Primitive;

std::string number(const model::Constant& constant, const model::Number& value,
                   const std::string& written) {
  return number_literal(value, written, std::get<Primitive>(constant.type.base));
}

std::string struct_definition(const model::Constant& constant, const std::string& name,
                              Types& types, Names& names, std::size_t indent) {
  const std::string blanks(indent, ' ');
  std::string result = "public static class " + name + "\n" + blanks + "{";
  std::set<std::string> seen;
  for (const auto& field : std::get<std::vector<model::StructValueField>>(constant.value)) {
    std::string field_name = pascal(field.field);
    if (field_name == name || is_inherited_name(field_name)) field_name += '_';
    if (!seen.insert(field_name).second) continue;  // Q15
    result += "\n" + std::string(indent + 4, ' ') +
              constant_definition(*field.constant, field_name, types, names, indent + 4);
  }
  return result + "\n" + blanks + "}";
}

}  // namespace

std::string constant_definition(const model::Constant& constant, const std::string& name,
                                Types& types, Names& names, std::size_t indent) {
  if (constant.is_struct) return struct_definition(constant, name, types, names, indent);
  if (const auto* text = std::get_if<std::string>(&constant.value)) {
    return "public const string " + name + " = " + unicode_literal(*text) + ";";
  }
  const std::string type = types.number(std::get<Primitive>(constant.type.base));
  if (const auto* numbers = std::get_if<std::vector<model::Number>>(&constant.value)) {
    const auto& written = std::get<ast::ArrayLiteral>(constant.written).items;
    std::vector<std::string> items;
    for (std::size_t i = 0; i < numbers->size(); ++i) {
      items.push_back(number(constant, (*numbers)[i], written[i].text));
    }
    return "public static " + names.library("System", "ReadOnlySpan") + "<" + type + "> " + name +
           " => [" + join(items, ", ") + "];";
  }
  const auto& written = std::get<ast::NumberLiteral>(constant.written).text;
  return "public const " + type + " " + name + " = " +
         number(constant, std::get<model::Number>(constant.value), written) + ";";
}

}  // namespace robdef::csharp
