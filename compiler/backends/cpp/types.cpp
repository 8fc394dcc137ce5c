// SPDX-License-Identifier: Apache-2.0
#include "compiler/backends/cpp/types.hpp"

#include <array>
#include <cstddef>
#include <limits>
#include <variant>

namespace robdef::cpp {
namespace {

using model::ArrayForm;
using model::ContainerForm;
using model::Primitive;

/// A primitive in C++: its type, and the literal that a variable begins with.
struct Row {
  Primitive primitive;
  std::string_view type;
  std::string_view literal;
  std::string_view header;
};
constexpr auto rows = std::to_array<Row>({
    {Primitive::void_, "void", "", ""},
    {Primitive::double_, "double", "0", ""},
    {Primitive::single, "float", "0", ""},
    {Primitive::int8, "::std::int8_t", "0", "<cstdint>"},
    {Primitive::uint8, "::std::uint8_t", "0", "<cstdint>"},
    {Primitive::int16, "::std::int16_t", "0", "<cstdint>"},
    {Primitive::uint16, "::std::uint16_t", "0", "<cstdint>"},
    {Primitive::int32, "::std::int32_t", "0", "<cstdint>"},
    {Primitive::uint32, "::std::uint32_t", "0", "<cstdint>"},
    {Primitive::int64, "::std::int64_t", "0", "<cstdint>"},
    {Primitive::uint64, "::std::uint64_t", "0", "<cstdint>"},
    {Primitive::string, "::std::string", "", "<string>"},
    {Primitive::cdouble, "::std::complex<double>", "", "<rr/complex.hpp>"},
    {Primitive::csingle, "::std::complex<float>", "", "<rr/complex.hpp>"},
    {Primitive::bool_, "bool", "false", ""},
});

const Row& row_of(Primitive primitive) {
  const Row& row = rows[static_cast<std::size_t>(primitive)];
  return row;
}

template <class... Cases>
struct Overloaded : Cases... {
  using Cases::operator()...;
};

std::string dimensions_text(const model::Type& type) {
  std::string text;
  for (const std::uint32_t dimension : type.dimensions) text += ", " + std::to_string(dimension);
  return text;
}

CppType plain(std::string text, bool is_by_value = false) {
  return {.text = text, .descriptor = std::move(text), .is_by_value = is_by_value};
}

std::uint64_t times(std::uint64_t a, std::uint64_t b) {
  constexpr std::uint64_t most = std::numeric_limits<std::uint64_t>::max();
  return b != 0 && a > most / b ? most : a * b;
}

bool reaches(const model::Record& from, const model::Record& to,
             std::set<const model::Record*>& seen) {
  for (const model::Field& field : from.fields) {
    const auto* next = std::get_if<const model::Record*>(&field.type.base);
    if (next == nullptr) continue;
    if (*next == &to) return true;
    if (seen.insert(*next).second && reaches(**next, to, seen)) return true;
  }
  return false;
}

}  // namespace

bool closes_cycle(const model::Record& from, const model::Record& to) {
  if (!from.is_recursive || !to.is_recursive) return false;
  if (&from == &to) return true;
  std::set<const model::Record*> seen;
  return reaches(to, from, seen);
}

std::uint64_t storage_size(const model::Type& type) {
  std::uint64_t size = sizeof(void*);
  if (type.container != ContainerForm::none) return size;
  if (const auto* primitive = std::get_if<Primitive>(&type.base)) {
    size = *primitive == Primitive::string ? sizeof(std::string) : model::size_of(*primitive);
  } else if (const auto* record = std::get_if<const model::Record*>(&type.base);
             record != nullptr && !(*record)->is_recursive) {
    size = 0;
    for (const model::Field& field : (*record)->fields) size += storage_size(field.type);
  }
  const bool is_counted = type.array == ArrayForm::fixed_length ||
                          type.array == ArrayForm::maximum_length ||
                          type.array == ArrayForm::fixed_shape;
  return is_counted ? times(size, type.element_count()) : size;
}

std::string Types::number(Primitive primitive) {
  const Row& row = row_of(primitive);
  if (!row.header.empty()) headers_.emplace(row.header);
  return std::string(row.type);
}

CppType Types::spell(const model::Type& type, const Place& place) {
  CppType item = base(type, place);
  if (type.array != ArrayForm::none && !std::holds_alternative<model::VarValue>(type.base)) {
    item = array(item, type, place);
  }
  return container(std::move(item), type.container);
}

CppType Types::base(const model::Type& type, const Place& place) {
  static const std::set<std::string> nothing;
  const std::set<std::string>& hidden = place.hidden == nullptr ? nothing : *place.hidden;
  return std::visit(
      Overloaded{
          [&](Primitive primitive) {
            CppType result = plain(number(primitive), primitive != Primitive::string);
            result.initial.literal = row_of(primitive).literal;
            return result;
          },
          [&](const model::Record* record) {
            const std::string name = names_.type(*record, hidden);
            if (record->kind != model::RecordKind::struct_) return plain(name);
            const bool is_recursive =
                place.record != nullptr && closes_cycle(*place.record, *record);
            headers_.insert(is_recursive ? "<rr/type.hpp>" : "<optional>");
            return plain((is_recursive ? "::rr::Recursive<" : "::std::optional<") + name + ">");
          },
          [&](const model::Enum* enumeration) {
            return plain(names_.type(*enumeration, hidden), true);
          },
          [&](model::VarValue) {
            headers_.insert("<rr/varvalue.hpp>");
            return plain("::rr::VarValue");
          },
          // Reported before: objects are no values.
          [&](const model::Object*) { return plain("void"); },
          [&](model::VarObject) { return plain("void"); },
          [&](model::Unknown) { return plain("void"); },
      },
      type.base);
}

CppType Types::array(const CppType& item, const model::Type& type, const Place& place) {
  const bool is_in_pod =
      place.record != nullptr && place.record->kind != model::RecordKind::struct_;
  // Items of containers are on the heap anyway.
  const bool is_in_place =
      is_in_pod || type.container != ContainerForm::none || storage_size(type) <= in_place_limit;
  const std::string of = "<" + item.text;
  const std::string dimensions = dimensions_text(type);
  headers_.insert("<rr/type.hpp>");
  // A long array is a plain one; its description and first value know the length.
  const auto limited = [&](const std::string& in_place, const std::string& descriptor) {
    if (is_in_place) return plain(in_place + of + dimensions + ">");
    CppType result = plain("::rr::Array" + of + ">");
    result.descriptor = descriptor + of + dimensions + ">";
    return result;
  };
  switch (type.array) {
    case ArrayForm::none:
      return item;
    case ArrayForm::any_length:
      return plain("::rr::Array" + of + ">");
    case ArrayForm::fixed_length: {
      if (is_in_place) headers_.insert("<array>");
      CppType result = limited("::std::array", "::rr::FixedLength");
      if (!is_in_place) result.initial.length = std::to_string(type.element_count());
      return result;
    }
    case ArrayForm::maximum_length:
      return limited("::rr::BoundedArray", "::rr::MaximumLength");
    case ArrayForm::any_shape:
      return plain("::rr::MultiArray" + of + ">");
    case ArrayForm::fixed_shape: {
      CppType result = limited("::rr::FixedMultiArray", "::rr::FixedShape");
      if (!is_in_place) {
        result.text = "::rr::MultiArray" + of + ">";
        result.initial = {.literal = {},
                          .length = std::to_string(type.element_count()),
                          .shape = dimensions.substr(2),
                          .item = item.text};
      }
      return result;
    }
  }
  return item;
}

CppType Types::container(CppType item, ContainerForm form) {
  std::string before;
  switch (form) {
    case ContainerForm::none:
    case ContainerForm::generator:
      return item;
    case ContainerForm::list:
      headers_.insert("<vector>");
      before = "::std::optional<::std::vector<";
      break;
    case ContainerForm::int32_map:
      headers_.insert({"<map>", "<cstdint>"});
      before = "::std::optional<::std::map<::std::int32_t, ";
      break;
    case ContainerForm::string_map:
      headers_.insert({"<map>", "<string>"});
      before = "::std::optional<::std::map<::std::string, ";
      break;
  }
  headers_.insert("<optional>");
  CppType result = plain(before + item.text + ">>");
  result.descriptor = before + item.descriptor + ">>";
  return result;
}

}  // namespace robdef::cpp
