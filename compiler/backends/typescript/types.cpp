// SPDX-License-Identifier: Apache-2.0
#include "compiler/backends/typescript/types.hpp"

#include <array>
#include <cstddef>
#include <variant>

namespace robdef::typescript {
namespace {

using model::ArrayForm;
using model::ContainerForm;
using model::Primitive;

struct Row {
  Primitive primitive;
  std::string_view type;
  std::string_view sent;
  std::string_view array;  // a typed array; empty where there is none
};
constexpr auto rows_of_types = std::to_array<Row>({
    {Primitive::void_, "void", "void", ""},
    {Primitive::double_, "number", "number", "Float64Array"},
    {Primitive::single, "number", "number", "Float32Array"},
    {Primitive::int8, "number", "number", "Int8Array"},
    {Primitive::uint8, "number", "number", "Uint8Array"},
    {Primitive::int16, "number", "number", "Int16Array"},
    {Primitive::uint16, "number", "number", "Uint16Array"},
    {Primitive::int32, "number", "number", "Int32Array"},
    {Primitive::uint32, "number", "number", "Uint32Array"},
    {Primitive::int64, "bigint", "bigint | number", "BigInt64Array"},
    {Primitive::uint64, "bigint", "bigint | number", "BigUint64Array"},
    {Primitive::string, "string", "string", ""},
    {Primitive::cdouble, "rr.Complex", "rr.Complex", ""},
    {Primitive::csingle, "rr.Complex", "rr.Complex", ""},
    {Primitive::bool_, "boolean", "boolean", ""},
});

const Row& row_of(Primitive primitive) {
  return rows_of_types[static_cast<std::size_t>(primitive)];
}

template <class... Cases>
struct Overloaded : Cases... {
  using Cases::operator()...;
};

/// `type` where a `[]` comes behind it.
std::string item_of(const std::string& type) {
  return type.find('|') == std::string::npos ? type : "(" + type + ")";
}

TsType same(const std::string& text) { return {text, text}; }

/// `unknown` has null already.
TsType or_null(const TsType& type) {
  const auto add = [](const std::string& text) {
    return text == "unknown" ? text : text + " | null";
  };
  return {add(type.text), add(type.sent)};
}

}  // namespace

TsType Types::spell(const model::Type& type) const {
  TsType result = base(type.base);
  const bool is_any = std::holds_alternative<model::VarValue>(type.base);
  if (type.array != ArrayForm::none && !is_any) {
    const bool has_dims =
        type.array == ArrayForm::any_shape || type.array == ArrayForm::fixed_shape;
    result = has_dims ? same("rr.MultiDimArray<" + row(type.base) + ">") : rows(type.base);
  }
  return container(result, type.container);
}

std::string Types::row(const model::Base& base) const { return rows(base).text; }

TsType Types::base(const model::Base& base) const {
  // Reported before: objects are no values.
  const auto refused = [](const auto&) { return same("unknown"); };
  return std::visit(Overloaded{[&](Primitive primitive) {
                                 const Row& row = row_of(primitive);
                                 return TsType{std::string(row.type), std::string(row.sent)};
                               },
                               [&](const model::Record* record) {
                                 const std::string name =
                                     names_.of(*record->definition, exported(code_name(*record)));
                                 const bool is_struct = record->kind == model::RecordKind::struct_;
                                 return is_struct ? or_null(same(name)) : same(name);
                               },
                               [&](const model::Enum* enumeration) {
                                 return same(names_.of(*enumeration->definition,
                                                       exported(code_name(*enumeration))));
                               },
                               [](model::VarValue) {
                                 return TsType{"rr.VarValue | null", "unknown"};
                               },
                               [&](const model::Object* object) { return refused(object); },
                               [&](model::VarObject object) { return refused(object); },
                               [&](model::Unknown unknown) { return refused(unknown); }},
                    base);
}

TsType Types::rows(const model::Base& base) const {
  const TsType item = this->base(base);
  const std::string plain = "readonly " + item_of(item.sent) + "[]";
  if (const auto* primitive = std::get_if<Primitive>(&base)) {
    const Row& row = row_of(*primitive);
    if (!row.array.empty()) {
      const std::string typed = names_.global(row.array);
      return {typed, typed + " | " + plain};
    }
  }
  return {item_of(item.text) + "[]", plain};
}

TsType Types::container(const TsType& item, ContainerForm form) const {
  const auto map = [&](const std::string& key) {
    return or_null({names_.global("Map") + "<" + key + ", " + item.text + ">",
                    names_.global("ReadonlyMap") + "<" + key + ", " + item.sent + ">"});
  };
  switch (form) {
    case ContainerForm::none:
    case ContainerForm::generator:
      return item;
    case ContainerForm::list:
      return or_null({item_of(item.text) + "[]", "readonly " + item_of(item.sent) + "[]"});
    case ContainerForm::int32_map:
      return map("number");
    case ContainerForm::string_map:
      return map("string");
  }
  return item;
}

}  // namespace robdef::typescript
