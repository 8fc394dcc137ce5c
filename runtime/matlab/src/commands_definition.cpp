// SPDX-License-Identifier: Apache-2.0
// What the definitions of a service say: texts, constants, empty structures.
#include "rr/error.hpp"
#include "rr/number.hpp"
#include "runtime/matlab/src/objects.hpp"

namespace rr::matlab {
namespace {

using dynamic::Kind;

// The last part of a qualified name.
std::string plain_name(const std::string& qualified) {
  const std::size_t dot = qualified.rfind('.');
  return dot == std::string::npos ? qualified : qualified.substr(dot + 1);
}

void set_field(mxArray* record, const std::string& name, mxArray* value) {
  mxSetFieldByNumber(record, 0, mxAddField(record, name.c_str()), value);
}

mxArray* constants_to_mex(const dynamic::Fields& constants) {
  mxArray* const made = mxCreateStructMatrix(1, 1, 0, nullptr);
  for (const auto& [name, value] : constants) {
    set_field(
        made, name,
        value.kind() == Kind::record ? constants_to_mex(value.fields()) : plain_to_mex(value));
  }
  return made;
}

// constants(object, service): struct
void constants(Runtime& runtime, Call& call) {
  const auto object = object_of(runtime, call);
  const dynamic::Definitions types = object->object().types();
  const std::string service = call.text(1);
  mxArray* const made = constants_to_mex(types.constants(service));
  const dynamic::DeclaredNames declared = types.declared(service);
  for (const std::string& name : declared.enums) {
    mxArray* const values = mxCreateStructMatrix(1, 1, 0, nullptr);
    for (const auto& [word, number] : types.type(name).enum_values()) {
      set_field(values, word, make_number<std::int32_t>(number));
    }
    set_field(made, plain_name(name), values);
  }
  for (const auto* names : {&declared.records, &declared.objects}) {
    for (const std::string& name : *names) {
      const dynamic::Fields inner = types.constants(name);
      if (!inner.empty()) set_field(made, plain_name(name), constants_to_mex(inner));
    }
  }
  call.give(made);
}

// The name of an enum's value; empty for a number that it does not have.
std::string name_of_value(const dynamic::ValueType& type, std::int32_t number) {
  for (const auto& [name, value] : type.enum_values()) {
    if (value == number) return name;
  }
  return {};
}

// `idle (0), running (3)`
std::string values_of(const dynamic::ValueType& type) {
  std::string text;
  for (const auto& [name, value] : type.enum_values()) {
    text += (text.empty() ? "" : ", ") + name + " (" + std::to_string(value) + ")";
  }
  return text;
}

// enum_name(object, type, number): text
void enum_name(Runtime& runtime, Call& call) {
  const auto object = object_of(runtime, call);
  const dynamic::ValueType type = object->object().types().type(call.text(1));
  if (type.kind() != Kind::enumeration) {
    throw Error(ErrorCode::invalid_argument, "`" + type.text() + "` is not an enum");
  }
  const auto number = read_number<std::int32_t>(call[2]);
  const std::string name = name_of_value(type, number);
  if (name.empty()) {
    throw Error(ErrorCode::out_of_range, "`" + type.text() + "` has no value " +
                                             std::to_string(number) + ": " + values_of(type));
  }
  call.give(make_text(name));
}

// shown_enum(object, member, value): `running (3)`; '' for a member that is of no enum
void shown_enum(Runtime& runtime, Call& call) {
  const auto object = object_of(runtime, call);
  const dynamic::ValueType type = object->resolve(call.text(1)).member.type;
  if (type.kind() != Kind::enumeration) return call.give(make_text(""));
  const auto number = read_number<std::int32_t>(call[2]);
  const std::string name = name_of_value(type, number);
  const std::string shown = std::to_string(number);
  call.give(make_text(name.empty() ? shown + " (no value of " + plain_name(type.name()) + ")"
                                   : name + " (" + shown + ")"));
}

mxArray* make_empty(const TypePlan& plan, int depth);

template <class Make>
mxArray* with_zero(ElementType number, const Make& make) {
  return with_number(number, [&]<class T>(std::type_identity<T>) { return make(T{}); });
}

// A struct array of records that are all the same.
mxArray* repeat_record(const TypePlan& item, const Dims& dims, int depth) {
  const mxArray* const one = make_empty(item, depth + 1);
  auto names = item.name_pointers;
  const int field_count = static_cast<int>(names.size());
  mxArray* const records =
      mxCreateStructArray(static_cast<mwSize>(dims.size()), dims.data(), field_count, names.data());
  for (std::size_t i = 0; i < count_of(records); ++i) {
    for (int k = 0; k < field_count; ++k) {
      mxSetFieldByNumber(records, static_cast<mwIndex>(i), k,
                         mxDuplicateArray(mxGetFieldByNumber(one, 0, k)));
    }
  }
  return records;
}

mxArray* empty_array(const TypePlan& plan, int depth) {
  const TypePlan& item = *plan.item;
  Dims dims;
  if (item.is_namedarray()) dims.push_back(static_cast<mwSize>(item.numbers));
  const auto fixed = fixed_dims(plan.type.text());
  for (const std::size_t dim : fixed) dims.push_back(static_cast<mwSize>(dim));
  if (fixed.empty()) {
    dims.push_back(0);
    dims.push_back(plan.has_dims ? 0 : 1);
  }
  dims = full_dims(std::move(dims));
  if (item.kind == Kind::record && !item.is_namedarray()) return repeat_record(item, dims, depth);
  return with_zero(item.number, [&]<class T>(T) { return make_room<T>(dims); });
}

// A struct in a struct is null at first, so one that contains itself has an end.
mxArray* empty_record(const TypePlan& plan, int depth) {
  if (plan.is_namedarray()) {
    const Dims dims{static_cast<mwSize>(plan.numbers), 1};
    return with_zero(plan.number, [&]<class T>(T) { return make_room<T>(dims); });
  }
  if (depth != 0 && plan.record_kind == RecordKind::struct_) return make_null();
  auto names = plan.name_pointers;
  mxArray* const record = mxCreateStructMatrix(1, 1, static_cast<int>(names.size()), names.data());
  for (std::size_t i = 0; i < names.size(); ++i) {
    mxSetFieldByNumber(record, 0, static_cast<int>(i), make_empty(*plan.fields[i], depth + 1));
  }
  return record;
}

// A value with nothing in it, to be filled by the user.
mxArray* make_empty(const TypePlan& plan, int depth) {
  switch (plan.kind) {
    case Kind::number:
    case Kind::enumeration:
      return with_zero(plan.number, [](auto zero) { return make_number(zero); });
    case Kind::text:
      return make_text("");
    case Kind::array:
      return empty_array(plan, depth);
    case Kind::list:
      return make_cells({});
    case Kind::int_map:
      return make_map(std::map<std::int32_t, mxArray*>());
    case Kind::string_map:
      return make_map(std::map<std::string, mxArray*>());
    case Kind::record:
      return empty_record(plan, depth);
    default:
      return make_null();
  }
}

// create(object, type): a struct with all fields
void create(Runtime& runtime, Call& call) {
  const auto object = object_of(runtime, call);
  call.give(
      make_empty(*object->connection()->plans.plan(object->object().types(), call.text(1)), 0));
}

// definitions(object): names, in cells
void definitions(Runtime& runtime, Call& call) {
  std::vector<mxArray*> names;
  for (const std::string& name : object_of(runtime, call)->object().types().services()) {
    names.push_back(make_text(name));
  }
  call.give(make_cells(names));
}

// definition(object, name): text
void definition(Runtime& runtime, Call& call) {
  call.give(make_text(object_of(runtime, call)->object().types().text(call.text(1))));
}

}  // namespace

mxArray* make_empty(const TypePlan& plan) { return make_empty(plan, 0); }

std::vector<Command> definition_commands() {
  return {{"constants", constants},   {"create", create},           {"enum_name", enum_name},
          {"shown_enum", shown_enum}, {"definitions", definitions}, {"definition", definition}};
}

}  // namespace rr::matlab
