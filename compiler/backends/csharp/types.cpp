// SPDX-License-Identifier: Apache-2.0
#include "compiler/backends/csharp/types.hpp"

#include <algorithm>
#include <array>
#include <variant>

#include "compiler/backends/words.hpp"

namespace robdef::csharp {
namespace {

using model::ArrayForm;
using model::ContainerForm;
using model::Primitive;

struct Row {
  Primitive primitive;
  std::string_view type;
  std::string_view codec;
  std::string_view space;  // empty for keywords
};
constexpr auto rows = std::to_array<Row>({
    {Primitive::void_, "void", "", ""},
    {Primitive::double_, "double", "Double", ""},
    {Primitive::single, "float", "Single", ""},
    {Primitive::int8, "sbyte", "Int8", ""},
    {Primitive::uint8, "byte", "UInt8", ""},
    {Primitive::int16, "short", "Int16", ""},
    {Primitive::uint16, "ushort", "UInt16", ""},
    {Primitive::int32, "int", "Int32", ""},
    {Primitive::uint32, "uint", "UInt32", ""},
    {Primitive::int64, "long", "Int64", ""},
    {Primitive::uint64, "ulong", "UInt64", ""},
    {Primitive::string, "string", "String", ""},
    {Primitive::cdouble, "Complex", "ComplexDouble", "System.Numerics"},
    {Primitive::csingle, "ComplexSingle", "ComplexSingle", runtime_space},
    {Primitive::bool_, "bool", "Bool", ""},
});

const Row& row_of(Primitive primitive) { return rows[static_cast<std::size_t>(primitive)]; }

template <class... Cases>
struct Overloaded : Cases... {
  using Cases::operator()...;
};

std::string dimensions_text(const model::Type& type) {
  std::vector<std::string> texts;
  for (const std::uint32_t dimension : type.dimensions) texts.push_back(std::to_string(dimension));
  return join(texts, ", ");
}

bool is_pod(const model::Type& type) {
  const auto* record = std::get_if<const model::Record*>(&type.base);
  return record != nullptr && (*record)->kind == model::RecordKind::pod;
}

/// `DoubleArrayList`, `Single3x2`: a name that says the type.
std::string name_of(const model::Type& type, Place place) {
  std::string name;
  for (const char c : type.text()) {
    const bool is_plain =
        (c >= 'a' && c <= 'z') || (c >= 'A' && c <= 'Z') || (c >= '0' && c <= '9');
    if (is_plain) {
      name += c;
    } else if (c == ',') {
      name += 'x';
    } else if (c == '-') {
      name += "Max";
    } else if (c == '*') {
      name += "MultiDim";
    } else if (c == ']' && name.ends_with('_')) {
      name += "Array";
    } else {
      name += '_';
    }
  }
  return pascal(name) + (place == Place::in_pod ? "Field" : "");
}

}  // namespace

std::string Types::value_codec() { return names_.library(runtime_space, "ValueCodec"); }

std::string Types::number(Primitive primitive) {
  const Row& row = row_of(primitive);
  return row.space.empty() ? std::string(row.type) : names_.library(row.space, row.type);
}

std::string Types::number_codec(Primitive primitive) {
  return value_codec() + "." + std::string(row_of(primitive).codec);
}

CsType Types::spell(const model::Type& type, Place place) {
  CsType result = base(type);
  if (type.array != ArrayForm::none && !std::holds_alternative<model::VarValue>(type.base)) {
    result = array(result, type, place);
  }
  return container(result, type);
}

CsType Types::item(const model::Type& type) {
  model::Type item = type;
  item.container = ContainerForm::none;
  item.array = ArrayForm::none;
  item.dimensions.clear();
  return base(item);
}

CsType Types::base(const model::Type& type) {
  const auto refused = [](const auto&) {
    return CsType{.text = "object", .codec = {}, .initial = {}};
  };
  return std::visit(Overloaded{[&](Primitive primitive) {
                                 if (primitive == Primitive::void_) return CsType{"void", "", ""};
                                 return CsType{number(primitive), number_codec(primitive),
                                               primitive == Primitive::string ? " = \"\";" : ""};
                               },
                               [&](const model::Record* record) {
                                 const std::string name =
                                     names_.type(*record->definition, pascal(code_name(*record)));
                                 const std::string value = names_.type_in_expression(
                                     *record->definition, pascal(code_name(*record)));
                                 const bool is_struct = record->kind == model::RecordKind::struct_;
                                 const bool is_pod = record->kind == model::RecordKind::pod;
                                 return CsType{name + (is_struct ? "?" : ""), value + ".RrCodec",
                                               is_pod ? " = new();" : ""};
                               },
                               [&](const model::Enum* enumeration) {
                                 const std::string name = names_.type(
                                     *enumeration->definition, pascal(code_name(*enumeration)));
                                 return CsType{name, value_codec() + ".Enum<" + name + ">()", ""};
                               },
                               [&](model::VarValue) {
                                 return CsType{names_.library(runtime_space, "VarValue") + "?",
                                               value_codec() + ".VarValue", ""};
                               },
                               // Reported before: objects are no values.
                               [&](const model::Object* object) { return refused(object); },
                               [&](model::VarObject object) { return refused(object); },
                               [&](model::Unknown unknown) { return refused(unknown); }},
                    type.base);
}

CsType Types::array(const CsType& item, const model::Type& type, Place place) {
  model::Type plain = type;
  plain.container = ContainerForm::none;
  const std::string dims = dimensions_text(type);
  const std::string count = std::to_string(type.element_count());
  const std::string items = item.text + "[]";
  const auto full = [&] {
    return is_pod(type)
               ? names_.library(runtime_space, "Pods") + ".New<" + item.text + ">(" + count + ")"
               : "new " + item.text + "[" + count + "]";
  };
  const auto multi = [&] {
    return names_.library(runtime_space, "MultiDimArray") + "<" + item.text + ">";
  };
  const auto made = [&](const std::string& text, const std::string& how) {
    return kept(plain, text, item.codec + "." + how, place);
  };
  switch (type.array) {
    case ArrayForm::none:
      return item;
    case ArrayForm::any_length:
      return {items, item.codec + ".Array", " = [];"};
    case ArrayForm::fixed_length:
      return {items, made(items, "FixedArray(" + dims + ")"), " = " + full() + ";"};
    case ArrayForm::maximum_length:
      return {items, made(items, "MaximumArray(" + dims + ")"), " = [];"};
    case ArrayForm::any_shape:
      return {multi(), item.codec + ".MultiDim", " = new();"};
    case ArrayForm::fixed_shape: {
      const std::string form = place == Place::in_pod ? "FlatMultiDim(" : "FixedMultiDim(";
      return {multi(), made(multi(), form + dims + ")"), " = new([" + dims + "], " + full() + ");"};
    }
  }
  return item;
}

CsType Types::container(const CsType& item, const model::Type& type) {
  const auto made = [&](const std::string& text, const std::string& how) {
    const std::string value = value_codec() + "." + how + "(" + item.codec + ")";
    return CsType{text + "?", kept(type, text + "?", value, Place::anywhere), ""};
  };
  const std::string space = "System.Collections.Generic";
  switch (type.container) {
    case ContainerForm::none:
    case ContainerForm::generator:
      return item;
    case ContainerForm::list:
      return made(names_.library(space, "List") + "<" + item.text + ">", "List");
    case ContainerForm::int32_map:
      return made(names_.library(space, "Dictionary") + "<int, " + item.text + ">", "Int32Map");
    case ContainerForm::string_map:
      return made(names_.library(space, "Dictionary") + "<string, " + item.text + ">", "StringMap");
  }
  return item;
}

std::string Types::kept(const model::Type& type, const std::string& text, const std::string& value,
                        Place place) {
  const auto known = codec_names_.find(value);
  if (known != codec_names_.end()) return "RrCodecs." + known->second;
  std::string name = name_of(type, place);
  const auto is_taken = [&] {
    return std::ranges::any_of(codecs_, [&](const CodecField& one) { return one.name == name; });
  };
  while (is_taken()) name += '_';
  codec_names_.emplace(value, name);
  codecs_.push_back({.name = name, .type = text, .value = value});
  return "RrCodecs." + name;
}

}  // namespace robdef::csharp
