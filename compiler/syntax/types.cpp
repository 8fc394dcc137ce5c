// SPDX-License-Identifier: Apache-2.0
// Looks at types as they are written. Reports R0131 and the warnings R0221, R0222, R0421, R0623,
// R0624.
#include "compiler/syntax/types.hpp"

#include <fmt/format.h>

#include "compiler/syntax/words.hpp"

namespace robdef::syntax {
namespace {

class TypeDoubts {
 public:
  explicit TypeDoubts(Report& report) : report_(report) {}

  void look_at(const ast::Declaration& declaration) {
    if (const auto* const record = std::get_if<ast::Record>(&declaration)) {
      for (const ast::Field& field : record->fields) {
        value(field.type);
        // In a pod a length of zero is an error of its own.
        if (record->kind != ast::RecordKind::pod) length(field.type);
      }
    } else if (const auto* const object = std::get_if<ast::Object>(&declaration)) {
      for (const ast::Member& written : object->members) member(written);
    } else if (const auto* const constant = std::get_if<ast::Constant>(&declaration)) {
      length(constant->type);
    }
  }

 private:
  void member(const ast::Member& member) {
    if (member.kind == ast::MemberKind::objref) return;
    if (member.kind == ast::MemberKind::memory) {
      memory(*member.type);
    } else if (member.type) {
      value(*member.type);
      length(*member.type);
    }
    for (const ast::Parameter& parameter : member.parameters) {
      value(parameter.type);
      length(parameter.type);
    }
  }

  void memory(const ast::TypeRef& type) {
    value(type);
    // A fixed length is an error of its own.
    if (type.array == ast::ArrayForm::maximum_length) length(type);
    if (type.container == ast::ContainerForm::list ||
        type.container == ast::ContainerForm::int32_map ||
        type.container == ast::ContainerForm::string_map) {
      report_.add(Code::R0624, type.container_span, "a memory in a list or map")
          .label("has no meaning on the wire")
          .help("remove the container")
          .edit(type.container_span, "");
    }
  }

  void value(const ast::TypeRef& type) {
    if (type.base.text == "object" || type.base.text == "varobject") {
      report_
          .add(Code::R0221, type.base.span,
               fmt::format("`{}` as the type of a value", type.base.text))
          .label("such a value cannot be sent")
          .help("use `varvalue` for a value of any type, `objref` for an object");
    } else if (type.base.text == "varvalue" && type.array != ast::ArrayForm::none) {
      report_.add(Code::R0222, type.array_span, "an array of varvalue")
          .label("has no effect")
          .help("a varvalue can hold an array; for several values write `varvalue{list}`");
    }
  }

  void length(const ast::TypeRef& type) {
    const bool has_length =
        type.array == ast::ArrayForm::fixed_length || type.array == ast::ArrayForm::maximum_length;
    if (!has_length || type.dimensions.front() != 0) return;
    report_.add(Code::R0421, type.array_span, "an array of length zero")
        .label("means no limit at run time")
        .help("write `[]`, or the length that is meant");
  }

  Report& report_;
};

}  // namespace

bool check_objref_type(const ast::TypeRef& type, Report& report) {
  if (is_built_in_type(type.base.text) && type.base.text != "varobject") {
    report
        .add(Code::R0131, type.base.span,
             fmt::format("an objref to `{}`, which is not an object", type.base.text))
        .label("an object type or `varobject` belongs here")
        .help("for a value, write `property`");
    return false;
  }
  if (type.array != ast::ArrayForm::none && type.array != ast::ArrayForm::any_length) {
    report.add(Code::R0131, type.array_span, "an objref with an array length")
        .label("an index is written `[]`");
    return false;
  }
  if (type.container == ast::ContainerForm::list ||
      type.container == ast::ContainerForm::generator) {
    report.add(Code::R0131, type.container_span, "an objref with a list or generator")
        .label("an index is written `[]`, `{int32}` or `{string}`");
    return false;
  }
  if (type.array != ast::ArrayForm::none && type.container != ast::ContainerForm::none) {
    report.add(Code::R0623, type.container_span, "an objref with two indexes")
        .label("a second index")
        .also(type.array_span, "the first");
  }
  return true;
}

void doubt_types(const ast::File& file, Report& report) {
  TypeDoubts doubts(report);
  for (const ast::Declaration& declaration : file.declarations) doubts.look_at(declaration);
}

}  // namespace robdef::syntax
