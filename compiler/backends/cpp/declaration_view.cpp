// SPDX-License-Identifier: Apache-2.0
// The views of what a definition declares, but for objects.
#include <utility>

#include "compiler/backends/cpp/constants.hpp"
#include "compiler/backends/cpp/view_parts.hpp"
#include "compiler/backends/literals.hpp"
#include "compiler/backends/words.hpp"
#include "compiler/output/cpp_layout.hpp"

namespace robdef::cpp {
namespace {

FieldView make_field(const model::Field& field, const model::Record& record,
                     const RecordNames& names, const Context& context) {
  const CppType type =
      context.types.spell(field.type, {.hidden = &names.hidden(), .record = &record});
  // Outside of the class its names hide nothing.
  const CppType described = context.types.spell(field.type, {.record = &record});
  FieldView view;
  view.wire_name = field.name;
  view.name = names.of(field.name);
  view.doc = doc_lines(field.documentation, 2);
  view.type = type.text;
  view.descriptor = described.descriptor;
  view.robdef_type = field.type.text();
  view.declaration = variable(type, view.name, 2);
  return view;
}

std::string record_table(const RecordView& view) {
  const std::string before = "constinit const ::rr::RecordType " + view.table + "{";
  const std::string name = "\"" + view.wire_name + "\"";
  const std::string operations = "::rr::record_operations<" + view.name + ">";
  if (view.is_namedarray) {
    return list({.before = before,
                 .items = {name, "::rr::number_of<" + view.number_type + ">", view.number_count,
                           operations},
                 .after = "};"},
                0);
  }
  const std::string fields = view.has_fields ? view.field_table : "{}";
  return list({.before = before,
               .items = {view.is_struct ? "::rr::RecordKind::struct_" : "::rr::RecordKind::pod",
                         name, fields, operations},
               .after = "};"},
              0);
}

/// `inline constexpr const ::rr::Type& rr::type_of<...> = ...;`
std::string specialization(const RecordView& view, const std::string& space) {
  const std::string left = "inline constexpr const ::rr::Type& rr::type_of<" + view.qualified + ">";
  const std::string right = "::" + space + "::" + view.table;
  if (left.size() + 2 <= line_width) return assignment(left, right, 0);
  const std::string type = "inline constexpr const ::rr::Type&";
  const std::string second = "    rr::type_of<" + view.qualified + "> =";
  if (second.size() <= line_width) return type + "\n" + second + "\n        " + right + ";";
  return type + " rr::type_of<\n    " + view.qualified + "> =\n    " + right + ";";
}

}  // namespace

ConstantView make_constant(const model::Constant& constant, const std::string& storage,
                           std::size_t indent, const Context& context) {
  ConstantView view;
  view.wire_name = constant.name;
  view.name = identifier(code_name(constant));
  view.doc = doc_lines(constant.documentation, indent);
  view.is_struct = constant.is_struct;
  view.type = constant_type(constant, context.types);
  view.value = constant_value(constant);
  view.definition = constant_definition(constant, view.name, storage, context.types, indent);
  return view;
}

std::vector<ConstantView> class_constants(const std::vector<model::Constant>& constants,
                                          const Context& context) {
  std::vector<ConstantView> views;
  for (const model::Constant& constant : constants) {
    views.push_back(make_constant(constant, "static constexpr", 2, context));
  }
  return views;
}

EnumView make_enum(const model::Enum& enumeration, const Context& context) {
  EnumView view;
  view.wire_name = enumeration.name;
  view.name = identifier(code_name(enumeration));
  view.qualified = qualified(*enumeration.definition, view.name);
  view.doc = doc_lines(enumeration.documentation, 0);
  view.has_values = !enumeration.values.empty();
  NameSet names(cpp_language, context.report);
  for (const model::EnumValue& value : enumeration.values) {
    const std::string name = identifier(code_name(value));
    names.add(name, value.span, "value",
              enumeration.definition->name + "." + enumeration.name + "." + value.name);
    view.values.push_back({.wire_name = value.name,
                           .name = name,
                           .value = enum_literal(value),
                           .doc = doc_lines(value.documentation, 2)});
  }
  return view;
}

ExceptionView make_exception(const model::Exception& exception, const Context& context) {
  ExceptionView view;
  view.wire_name = exception.definition->name + "." + exception.name;
  view.name = identifier(code_name(exception));
  view.qualified = qualified(*exception.definition, view.name);
  view.doc = doc_lines(exception.documentation, 0);
  for (const char* header : {"<rr/error.hpp>", "<rr/varvalue.hpp>", "<string>", "<utility>"}) {
    context.types.include(header);
  }
  // A parameter called like its class would hide it.
  std::set<std::string> taken{view.name};
  view.error = context.names.local("error", taken);
  const std::string message = context.names.local("message", taken);
  const std::string subname = context.names.local("subname", taken);
  const std::string parameter = context.names.local("parameter", taken);
  std::set<std::string> other;
  view.parameter = context.names.local("error", other);
  const std::string head =
      list({.before = "explicit " + view.name + "(",
            .items = {"::std::string " + message, "::std::string " + subname + " = {}",
                      "const ::rr::VarValue& " + parameter + " = {}"},
            .after = ")"},
           2);
  view.constructor =
      head + "\n      " +
      list({.before = ": ::rr::Error(",
            .items = {"::rr::ErrorCode::remote_error", "\"" + view.wire_name + "\"",
                      "::std::move(" + message + ")", "::std::move(" + subname + ")", parameter},
            .after = ") {}"},
           6);
  return view;
}

RecordView make_record(const model::Record& record, const Context& context) {
  const RecordNames names(record, context.report);
  RecordView view;
  describe(view, record);
  view.name = view.class_name = identifier(code_name(record));
  view.qualified = qualified(*record.definition, view.name);
  view.doc = doc_lines(record.documentation, 0);
  if (view.is_namedarray) view.number_type = context.types.number(record.number);
  view.constants = class_constants(record.constants, context);
  for (const model::Field& field : record.fields) {
    view.fields.push_back(make_field(field, record, names, context));
  }
  view.table = table_name("type", record.name);
  view.field_table = table_name("fields", record.name);
  view.table_definition = record_table(view);
  view.specialization = specialization(view, namespace_of(record.definition->name));
  context.types.include("<rr/type.hpp>");
  return view;
}

}  // namespace robdef::cpp
