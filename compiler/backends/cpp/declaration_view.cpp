// SPDX-License-Identifier: Apache-2.0
// The views of what a definition declares, but for objects.
#include <utility>

#include "compiler/backends/cpp/constants.hpp"
#include "compiler/backends/cpp/view_parts.hpp"
#include "compiler/backends/literals.hpp"

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
  view.doc = doc_lines(field.documentation, class_indent);
  view.type = type.text;
  view.descriptor = described.descriptor;
  view.robdef_type = field.type.text();
  view.initial = type.initial;
  return view;
}

}  // namespace

ConstantView make_constant(const model::Constant& constant, bool in_class, const Context& context) {
  ConstantView view;
  view.wire_name = constant.name;
  view.name = identifier(code_name(constant));
  view.doc = doc_lines(constant.documentation, in_class ? class_indent : 0);
  view.is_struct = constant.is_struct;
  view.in_class = in_class;
  if (view.is_struct) {
    view.parts = constant_parts(constant, view.name, context.types);
  } else {
    describe(view, constant, context.types);
  }
  return view;
}

std::vector<ConstantView> class_constants(const std::vector<model::Constant>& constants,
                                          const Context& context) {
  std::vector<ConstantView> views;
  for (const model::Constant& constant : constants) {
    views.push_back(make_constant(constant, true, context));
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
  view.message = context.names.local("message", taken);
  view.subname = context.names.local("subname", taken);
  view.parameter = context.names.local("parameter", taken);
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
  context.types.include("<rr/type.hpp>");
  return view;
}

}  // namespace robdef::cpp
