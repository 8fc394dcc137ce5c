// SPDX-License-Identifier: Apache-2.0
#include "compiler/model/model.hpp"

#include <fmt/format.h>

#include <array>
#include <concepts>
#include <limits>
#include <utility>

namespace robdef::model {
namespace {

struct PrimitiveEntry {
  std::string_view name;
  std::size_t size;
};

// By number on the wire.
constexpr std::array<PrimitiveEntry, 15> primitives{{{"void", 0},
                                                     {"double", 8},
                                                     {"single", 4},
                                                     {"int8", 1},
                                                     {"uint8", 1},
                                                     {"int16", 2},
                                                     {"uint16", 2},
                                                     {"int32", 4},
                                                     {"uint32", 4},
                                                     {"int64", 8},
                                                     {"uint64", 8},
                                                     {"string", 1},
                                                     {"cdouble", 16},
                                                     {"csingle", 8},
                                                     {"bool", 1}}};

struct BaseText {
  std::string operator()(Primitive primitive) const { return std::string(name_of(primitive)); }
  std::string operator()(const Record* record) const { return record->qualified_name(); }
  std::string operator()(const Enum* enumeration) const {
    return enumeration->definition->name + '.' + enumeration->name;
  }
  std::string operator()(const Object* object) const { return object->qualified_name(); }
  std::string operator()(VarValue) const { return "varvalue"; }
  std::string operator()(VarObject) const { return "varobject"; }
  std::string operator()(Unknown) const { return "unknown"; }
};

// Unknown does not come here.
struct SameBase {
  bool operator()(VarValue, VarValue) const { return true; }
  bool operator()(VarObject, VarObject) const { return true; }
  template <std::equality_comparable Base>
  bool operator()(Base a, Base b) const {
    return a == b;
  }
  template <class One, class Other>
  bool operator()(const One&, const Other&) const {
    return false;
  }
};

std::string array_text(ArrayForm form, const std::vector<std::uint32_t>& dimensions) {
  switch (form) {
    case ArrayForm::none:
      return "";
    case ArrayForm::any_length:
      return "[]";
    case ArrayForm::any_shape:
      return "[*]";
    case ArrayForm::fixed_length:
      return fmt::format("[{}]", dimensions.front());
    case ArrayForm::maximum_length:
      return fmt::format("[{}-]", dimensions.front());
    case ArrayForm::fixed_shape:
      break;
  }
  return fmt::format("[{}{}]", fmt::join(dimensions, ","), dimensions.size() == 1 ? "," : "");
}

}  // namespace

std::string_view name_of(Primitive primitive) {
  return primitives[static_cast<std::size_t>(primitive)].name;
}

std::optional<Primitive> primitive_of(std::string_view word) {
  for (std::size_t number = 0; number < primitives.size(); ++number) {
    if (primitives[number].name == word) return static_cast<Primitive>(number);
  }
  return std::nullopt;
}

std::size_t size_of(Primitive primitive) {
  return primitives[static_cast<std::size_t>(primitive)].size;
}

bool is_numeric(Primitive primitive) {
  return primitive != Primitive::void_ && primitive != Primitive::string;
}

std::string_view text_of(ContainerForm container) {
  switch (container) {
    case ContainerForm::none:
      return "";
    case ContainerForm::list:
      return "{list}";
    case ContainerForm::int32_map:
      return "{int32}";
    case ContainerForm::string_map:
      return "{string}";
    case ContainerForm::generator:
      return "{generator}";
  }
  return "";
}

std::string text_of(const ast::Version& version) {
  auto end = version.numbers.end();
  while (end - version.numbers.begin() > 2 && *(end - 1) == 0) --end;
  return fmt::format("{}", fmt::join(version.numbers.begin(), end, "."));
}

std::string_view name_of(RecordKind kind) {
  switch (kind) {
    case RecordKind::struct_:
      return "struct";
    case RecordKind::pod:
      return "pod";
    case RecordKind::namedarray:
      return "namedarray";
  }
  return "";
}

std::string_view name_of(MemberKind kind) {
  switch (kind) {
    case MemberKind::property:
      return "property";
    case MemberKind::function:
      return "function";
    case MemberKind::event:
      return "event";
    case MemberKind::objref:
      return "objref";
    case MemberKind::pipe:
      return "pipe";
    case MemberKind::callback:
      return "callback";
    case MemberKind::wire:
      return "wire";
    case MemberKind::memory:
      return "memory";
  }
  return "";
}

std::uint64_t Type::element_count() const {
  if (array == ArrayForm::none) return 1;
  if (dimensions.empty()) return 0;
  std::uint64_t count = 1;
  for (const std::uint32_t dimension : dimensions) {
    if (dimension == 0) return 0;
    constexpr std::uint64_t most = std::numeric_limits<std::uint64_t>::max();
    count = count > most / dimension ? most : count * dimension;
  }
  return count;
}

bool Type::is_void() const {
  const auto* primitive = std::get_if<Primitive>(&base);
  return primitive != nullptr && *primitive == Primitive::void_;
}

std::string Type::suffix() const {
  return array_text(array, dimensions) + std::string(text_of(container));
}

std::string Type::text() const { return std::visit(BaseText{}, base) + suffix(); }

bool Type::is_same_as(const Type& other) const {
  if (std::holds_alternative<Unknown>(base) || std::holds_alternative<Unknown>(other.base)) {
    return true;
  }
  return std::visit(SameBase{}, base, other.base) && array == other.array &&
         dimensions == other.dimensions && container == other.container;
}

bool Modifier::is_same_as(const Modifier& other) const {
  return name == other.name && arguments == other.arguments;
}

std::string Record::qualified_name() const { return definition->name + '.' + name; }
std::string Object::qualified_name() const { return definition->name + '.' + name; }

const Definition* Model::find(std::string_view name) const {
  const auto found = by_name_.find(name);
  return found == by_name_.end() ? nullptr : found->second;
}

Definition& Model::add(std::string name) {
  Definition& added = *definitions_.emplace_back(std::make_unique<Definition>());
  added.name = std::move(name);
  by_name_.try_emplace(added.name, &added);
  return added;
}

}  // namespace robdef::model
