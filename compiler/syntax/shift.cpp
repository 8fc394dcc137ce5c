// SPDX-License-Identifier: Apache-2.0
#include "compiler/syntax/shift.hpp"

#include <variant>
#include <vector>

namespace robdef::syntax {
namespace {

void shift(Span& span, const Shift& by) {
  span = {by.source, by.moved(span.begin), by.moved(span.end)};
}

void shift(ast::Name& name, const Shift& by) { shift(name.span, by); }

void shift(ast::TypeRef& type, const Shift& by) {
  shift(type.span, by);
  shift(type.base, by);
  // Without brackets there is no place to move.
  if (type.array != ast::ArrayForm::none) shift(type.array_span, by);
  if (type.container != ast::ContainerForm::none) shift(type.container_span, by);
}

void shift(std::vector<ast::Modifier>& modifiers, const Shift& by) {
  for (ast::Modifier& modifier : modifiers) {
    shift(modifier.name, by);
    shift(modifier.span, by);
    for (ast::ModifierArgument& argument : modifier.arguments) shift(argument.span, by);
  }
}

void shift(ast::NumberLiteral& number, const Shift& by) { shift(number.span, by); }
void shift(ast::StringLiteral& text, const Shift& by) { shift(text.span, by); }
void shift(ast::ArrayLiteral& array, const Shift& by) {
  shift(array.span, by);
  for (ast::NumberLiteral& item : array.items) shift(item, by);
}
void shift(ast::StructLiteral& fields, const Shift& by) {
  shift(fields.span, by);
  for (ast::StructLiteralField& one : fields.fields) {
    shift(one.field, by);
    shift(one.constant, by);
  }
}

void shift(ast::Implements& implements, const Shift& by) {
  shift(implements.name, by);
  shift(implements.span, by);
}

void shift(ast::Option& option, const Shift& by) { shift(option.span, by); }

template <class Node>
void shift_all(std::vector<Node>& nodes, const Shift& by) {
  for (Node& node : nodes) shift(node, by);
}

}  // namespace

void shift(ast::Field& field, const Shift& by) {
  shift(field.type, by);
  shift(field.name, by);
  shift(field.modifiers, by);
  shift(field.span, by);
}

void shift(ast::Member& member, const Shift& by) {
  if (member.type) shift(*member.type, by);
  shift(member.name, by);
  for (ast::Parameter& parameter : member.parameters) {
    shift(parameter.type, by);
    shift(parameter.name, by);
  }
  shift(member.modifiers, by);
  shift(member.span, by);
}

void shift(ast::Constant& constant, const Shift& by) {
  shift(constant.type, by);
  shift(constant.name, by);
  std::visit([&by](auto& value) { shift(value, by); }, constant.value);
  shift(constant.span, by);
}

void shift(ast::Exception& exception, const Shift& by) {
  shift(exception.name, by);
  shift(exception.span, by);
}

void shift(ast::EnumValue& value, const Shift& by) {
  shift(value.name, by);
  if (value.value) shift(*value.value, by);
}

void shift(ast::Enum& enumeration, const Shift& by) {
  shift(enumeration.name, by);
  shift_all(enumeration.values, by);
  shift(enumeration.span, by);
}

void shift(ast::Record& record, const Shift& by) {
  shift(record.name, by);
  shift_all(record.constants, by);
  shift_all(record.fields, by);
  shift_all(record.options, by);
  shift(record.span, by);
}

void shift(ast::Object& object, const Shift& by) {
  shift(object.name, by);
  shift_all(object.implements, by);
  shift_all(object.constants, by);
  shift_all(object.members, by);
  shift_all(object.options, by);
  shift(object.span, by);
}

}  // namespace robdef::syntax
