// SPDX-License-Identifier: Apache-2.0
// Rules on types: V11, V13, V14, V17. Unknown types are passed over: they have been reported.
#include <string>
#include <string_view>
#include <variant>

#include "compiler/model/phrases.hpp"
#include "compiler/model/print.hpp"
#include "compiler/model/rules.hpp"

namespace robdef::model::rules {
namespace {

// Where a type stands, as far as rules differ.
enum class Place { value, record_field, result, memory };

// Calls `visit(type, place)` for each value type of a definition: not for objrefs, which name
// objects, and not for the missing type of events.
template <class Visitor>
void each_type(const Definition& definition, Visitor visit) {
  for (const Record& record : definition.records) {
    const Place place = record.kind == RecordKind::struct_ ? Place::value : Place::record_field;
    for (const Field& field : record.fields) visit(field.type, place);
  }
  for (const Object& object : definition.objects) {
    for (const Member& member : object.members) {
      switch (member.kind) {
        case MemberKind::property:
        case MemberKind::pipe:
        case MemberKind::wire:
          visit(member.type, Place::value);
          break;
        case MemberKind::memory:
          visit(member.type, Place::memory);
          break;
        case MemberKind::function:
        case MemberKind::callback:
          visit(member.type, Place::result);
          break;
        case MemberKind::event:
        case MemberKind::objref:
          break;
      }
      for (const Parameter& parameter : member.parameters) visit(parameter.type, Place::value);
      if (member.generator_parameter) visit(member.generator_parameter->type, Place::value);
    }
  }
}

// What bars a type from being a value: the word for it, or nothing.
struct ArrayBan {
  std::string_view operator()(Primitive primitive) const {
    return primitive == Primitive::string ? "string" : "";
  }
  std::string_view operator()(const Record* record) const {
    return record->kind == RecordKind::struct_ ? "struct" : "";
  }
  std::string_view operator()(const Enum*) const { return "enum"; }
  std::string_view operator()(const Object*) const { return ""; }
  std::string_view operator()(VarValue) const { return ""; }
  std::string_view operator()(VarObject) const { return ""; }
  std::string_view operator()(Unknown) const { return ""; }
};

const Object* object_of(const Type& type) {
  const auto* object = std::get_if<const Object*>(&type.base);
  return object == nullptr ? nullptr : *object;
}

bool is_array_of_the_wrong_kind(const Type& type) {
  return type.array != ArrayForm::none && !std::visit(ArrayBan{}, type.base).empty();
}

bool is_memory_item(const Type& type) {
  if (const auto* primitive = std::get_if<Primitive>(&type.base)) return is_numeric(*primitive);
  const auto* record = std::get_if<const Record*>(&type.base);
  return record != nullptr && (*record)->kind != RecordKind::struct_;
}

// V17 for one memory whose type is a value at all.
void check_memory(const Member& memory, Report& report) {
  const Type& type = memory.type;
  if (!is_memory_item(type)) {
    report.add(Code::R0604, type.span, "a memory of something else than numbers")
        .label("no number, pod or namedarray")
        .help("a `property` or `pipe` can carry any value");
    return;
  }
  if (type.array == ArrayForm::none) {
    report.add(Code::R0604, type.span, "a memory that is not an array")
        .label("a single value")
        .help("write `[]` behind the type for one dimension, `[*]` for several");
    return;
  }
  if (type.array == ArrayForm::any_length || type.array == ArrayForm::any_shape) return;
  report.add(Code::R0604, type.span, "a memory with a length in its type")
      .label("the length of a memory is asked for at run time")
      .help("write `[]` for one dimension, `[*]` for several");
}

// V14 for a type that still has its generator container, which only functions take off.
void report_misplaced_generator(const Type& type, std::string_view why, Report& report) {
  report.add(Code::R0601, type.span, "a generator in a place where it cannot be")
      .label(std::string(why))
      .help("a function can return a generator, and take one as its last parameter");
}

bool is_generator(const Type& type) { return type.container == ContainerForm::generator; }

// V14 for one member.
void check_generators(const Member& member, const Definition& definition, Report& report) {
  const bool is_function = member.kind == MemberKind::function;
  if (is_generator(member.type)) {
    report_misplaced_generator(member.type, "only functions have generators", report);
  }
  for (const Parameter& parameter : member.parameters) {
    if (!is_generator(parameter.type)) continue;
    report_misplaced_generator(
        parameter.type,
        is_function ? "a generator is the last parameter" : "only functions have generators",
        report);
  }
  const bool returns =
      member.generator == GeneratorForm::returns || member.generator == GeneratorForm::both;
  if (returns && member.type.is_void()) {
    report.add(Code::R0601, member.type.span, "a generator of void")
        .label("each step has to return something")
        .help("return the type of one step, or plain `void`");
  }
  if (member.generator == GeneratorForm::takes && !member.type.is_void() &&
      !std::holds_alternative<Unknown>(member.type.base)) {
    report
        .add(Code::R0601, member.type.span,
             "a function with a generator parameter returns a plain value")
        .label("neither `void` nor a generator")
        .also(member.generator_parameter->type.span, "the generator parameter")
        .help("return `void`, or a value with each step: " +
              in_ticks(written_base(member.type, definition) + "{generator}"));
  }
}

}  // namespace

void types_are_values(const Definition& definition, Report& report) {
  each_type(definition, [&](const Type& type, Place place) {
    if (place == Place::record_field) return;  // V18 and V20 say more
    if (const Object* object = object_of(type)) {
      report.add(Code::R0206, type.span, "object " + in_ticks(object->name) + " used as a value")
          .label("objects are not sent by value")
          .also(object->span, "declared as an object here")
          .help("write " + in_ticks("objref " + written_base(type, definition)) +
                " and a name to refer to one");
    } else if (is_array_of_the_wrong_kind(type)) {
      const std::string_view kind = std::visit(ArrayBan{}, type.base);
      report
          .add(Code::R0206, type.span,
               "an array of " + std::string(kind) + (kind == "string" ? "s" : " values"))
          .label("only numbers, pods and namedarrays form arrays")
          .help("write " + in_ticks(written_base(type, definition) + "{list}"))
          .edit(type.span, written_base(type, definition) + "{list}");
    }
  });
}

void void_is_only_returned(const Definition& definition, Report& report) {
  each_type(definition, [&report](const Type& type, Place place) {
    if (!type.is_void() || is_generator(type)) return;
    const bool is_bare = type.array == ArrayForm::none && type.container == ContainerForm::none;
    if (place == Place::result && is_bare) return;
    report.add(Code::R0207, type.span, "`void` in a place where a value is needed")
        .label(place == Place::result ? "`void` stands alone"
                                      : "only functions and callbacks return `void`");
  });
}

void generators_belong_to_functions(const Definition& definition, Report& report) {
  for (const Record& record : definition.records) {
    for (const Field& field : record.fields) {
      if (!is_generator(field.type)) continue;
      report_misplaced_generator(field.type, "only functions have generators", report);
    }
  }
  for (const Object& object : definition.objects) {
    for (const Member& member : object.members) check_generators(member, definition, report);
  }
}

void memories_are_arrays(const Definition& definition, Report& report) {
  for (const Object& object : definition.objects) {
    for (const Member& member : object.members) {
      if (member.kind != MemberKind::memory) continue;
      const Type& type = member.type;
      const bool is_reported = std::holds_alternative<Unknown>(type.base) || type.is_void() ||
                               is_generator(type) || object_of(type) != nullptr ||
                               is_array_of_the_wrong_kind(type);
      if (!is_reported) check_memory(member, report);
    }
  }
}

}  // namespace robdef::model::rules
