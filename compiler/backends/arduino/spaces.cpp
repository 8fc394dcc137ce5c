// SPDX-License-Identifier: Apache-2.0
#include "compiler/backends/arduino/spaces.hpp"

#include <algorithm>
#include <array>

#include "compiler/backends/arduino/names.hpp"
#include "compiler/backends/cpp/constants.hpp"
#include "compiler/backends/cpp/literal_text.hpp"
#include "compiler/backends/literals.hpp"
#include "compiler/backends/words.hpp"
#include "compiler/output/prose.hpp"

namespace robdef::arduino {
namespace {

/// Codes from 192 on are exceptions.
constexpr std::size_t exception_limit = 64;

std::vector<std::string> doc_lines(std::string_view documentation) {
  return prose(without_limits(documentation), "/// ", 100);
}

std::string number_type(model::Primitive primitive) {
  switch (primitive) {
    case model::Primitive::double_:
      return "double";
    case model::Primitive::single:
      return "float";
    case model::Primitive::bool_:
      return "bool";
    default:
      return std::string(model::name_of(primitive)) + "_t";
  }
}

/// Whole lines that define a constant; those of struct constants stand behind their parts.
void add_constant(const model::Constant& constant, const std::string& name,
                  std::vector<std::string>& lines) {
  for (const std::string& line : doc_lines(constant.documentation)) lines.push_back(line);
  if (const auto* fields = std::get_if<std::vector<model::StructValueField>>(&constant.value)) {
    lines.push_back("namespace " + name + " {");
    for (const model::StructValueField& field : *fields) {
      const std::string part = identifier(camel(field.field));
      const std::string of = identifier(code_name(*field.constant));
      lines.push_back(field.constant->is_struct
                          ? "namespace " + part + " = " + of + ";"
                          : "constexpr const auto& " + part + " = " + of + ";");
    }
    lines.emplace_back("}");
    return;
  }
  if (const auto* text = std::get_if<std::string>(&constant.value)) {
    lines.emplace_back("/// In flash.");
    lines.push_back("constexpr char " + name + "[] PROGMEM = " + cpp::string_literal(*text) + ";");
    return;
  }
  const auto primitive = std::get<model::Primitive>(constant.type.base);
  if (const auto* numbers = std::get_if<std::vector<model::Number>>(&constant.value)) {
    const auto& written = std::get<ast::ArrayLiteral>(constant.written).items;
    std::vector<std::string> items;
    for (std::size_t at = 0; at < numbers->size(); ++at) {
      items.push_back(number_literal((*numbers)[at], written[at].text, primitive));
    }
    if (items.empty()) return;  // C++ has no empty arrays
    lines.emplace_back("/// In flash.");
    lines.push_back("constexpr " + number_type(primitive) + " " + name + "[] PROGMEM = {" +
                    join(items, ", ") + "};");
    return;
  }
  lines.push_back("constexpr " + number_type(primitive) + " " + name + " = " +
                  number_literal(std::get<model::Number>(constant.value),
                                 std::get<ast::NumberLiteral>(constant.written).text, primitive) +
                  ";");
}

/// `path` is that of what has the constants.
void add_constants(const std::vector<model::Constant>& constants, const std::string& block,
                   const std::string& path, Scope& scope, Report& report,
                   std::vector<std::string>& lines) {
  if (constants.empty()) return;
  Scope inner(report);
  const std::string space =
      block.empty() ? "" : scope.add(block + "Constants", block, constants.front().span, path);
  if (!block.empty()) lines.push_back("namespace " + space + " {");
  for (const model::Constant& constant : constants) {
    Scope& own = block.empty() ? scope : inner;
    add_constant(
        constant,
        own.add(code_name(constant), constant.name, constant.span, path + "." + constant.name),
        lines);
  }
  if (!block.empty()) lines.push_back("}  // namespace " + space);
}

RecordView make_record(const model::Record& record, BoardTypes& types, Report& report) {
  RecordView view{
      .name = identifier(code_name(record)), .doc = doc_lines(record.documentation), .fields = {}};
  Scope scope(report);
  // Limits were reported when the record was spelled for the first time.
  Report unheard;
  for (const model::Field& field : record.fields) {
    const Limits limits(field.documentation, field.span, unheard);
    const std::string name = scope.add(camel(code_name(field)), field.name, field.span,
                                       record.qualified_name() + "." + field.name);
    view.fields.push_back({types.spell(field.type, {limits, ""}).text, name});
  }
  view.has_fields = !view.fields.empty();
  return view;
}

EnumView make_enum(const model::Enum& enumeration, Report& report) {
  EnumView view{.name = identifier(code_name(enumeration)),
                .doc = doc_lines(enumeration.documentation),
                .values = {}};
  Scope scope(report);
  const std::string path = enumeration.definition->name + "." + enumeration.name + ".";
  for (const model::EnumValue& value : enumeration.values) {
    for (const std::string& line : doc_lines(value.documentation)) view.values.push_back(line);
    view.values.push_back(scope.add(code_name(value), value.name, value.span, path + value.name) +
                          " = " + enum_literal(value) + ",");
  }
  return view;
}

}  // namespace

SpaceView make_space(const model::Definition& definition, BoardTypes& types, Report& report) {
  SpaceView view;
  view.doc = doc_lines(definition.documentation);
  for (const std::string& segment : segments_of(definition.name)) {
    view.opening.push_back("namespace " + identifier(segment) + " {");
    view.closing.insert(view.closing.begin(), "}  // namespace " + identifier(segment));
  }
  Scope scope(report);
  for (const model::Enum& enumeration : definition.enums) {
    (void)scope.add(code_name(enumeration), enumeration.name, enumeration.span,
                    definition.name + "." + enumeration.name);
    view.enums.push_back(make_enum(enumeration, report));
  }
  const std::vector<const model::Record*> spelled = types.records();
  for (const model::Record* record : spelled) {
    if (record->definition != &definition) continue;
    (void)scope.add(code_name(*record), record->name, record->span, record->qualified_name());
    view.records.push_back(make_record(*record, types, report));
  }
  add_constants(definition.constants, "", definition.name, scope, report, view.constants);
  for (const model::Record& record : definition.records) {
    add_constants(record.constants, code_name(record), record.qualified_name(), scope, report,
                  view.constants);
  }
  for (const model::Object& object : definition.objects) {
    add_constants(object.constants, code_name(object), object.qualified_name(), scope, report,
                  view.constants);
  }
  return view;
}

std::vector<std::string> exception_lines(const model::Definition& definition, Report& report) {
  std::vector<std::string> lines;
  Scope scope(report);
  for (const model::Exception& exception : definition.exceptions) {
    const std::size_t number = lines.size() + 192;
    if (number >= 192 + exception_limit) {
      report.add(Code::R0922, exception.span, "a board has 64 exceptions at most")
          .help("remove those that the board does not throw");
      break;
    }
    lines.push_back("constexpr rr::Status " +
                    scope.add(code_name(exception), exception.name, exception.span,
                              definition.name + "." + exception.name) +
                    " = static_cast<rr::Status>(" + std::to_string(number) + ");");
  }
  return lines;
}

ServiceTexts service_texts(const model::Definition& definition, const model::Object& root) {
  std::vector<std::string> texts{root.name + " " + root.qualified_name()};
  std::vector<const model::Definition*> order{&definition};
  for (std::size_t at = 0; at < order.size(); ++at) {
    texts.push_back(order[at]->text);
    for (const model::Definition* import : order[at]->imports) {
      if (std::ranges::find(order, import) == order.end()) order.push_back(import);
    }
  }
  ServiceTexts result;
  std::uint64_t hash = 0xCBF29CE484222325;
  const auto take = [&hash](char byte) {
    hash = (hash ^ static_cast<unsigned char>(byte)) * 0x100000001B3;
  };
  for (const std::string& text : texts) {
    std::ranges::for_each(text, take);
    take('\0');
    result.bytes += text.size() + 1;
    result.views.push_back(
        {"rrText" + std::to_string(result.views.size()), cpp::literal_text(text)});
  }
  std::vector<std::string> bytes;
  for (int at = 0; at < 8; ++at) bytes.push_back(std::to_string((hash >> (8 * at)) & 0xFF));
  result.hash = join(bytes, ", ");
  return result;
}

}  // namespace robdef::arduino
