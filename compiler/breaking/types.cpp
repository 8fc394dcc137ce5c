// SPDX-License-Identifier: Apache-2.0
#include "compiler/breaking/types.hpp"

#include <type_traits>
#include <variant>

namespace robdef::breaking {
namespace {

// Names have no limit, and one may be in as many messages as there are lines.
constexpr std::size_t longest_name = 100;

std::string cut(std::string_view name) {
  if (name.size() <= longest_name) return std::string(name);
  return std::string(name.substr(0, longest_name)) + "...";
}

// Values of an enum travel as int32.
bool is_int32(const model::Base& base) {
  const auto* const primitive = std::get_if<model::Primitive>(&base);
  return std::holds_alternative<const model::Enum*>(base) ||
         (primitive != nullptr && *primitive == model::Primitive::int32);
}

TypeChange compare_bases(const model::Base& before, const model::Base& now,
                         const Pairing& pairing) {
  const bool is_same = std::visit(
      [&](const auto& old_base, const auto& new_base) {
        using Old = std::decay_t<decltype(old_base)>;
        using New = std::decay_t<decltype(new_base)>;
        // What could not be resolved was reported.
        if constexpr (std::is_same_v<Old, model::Unknown> || std::is_same_v<New, model::Unknown>) {
          return true;
        } else if constexpr (!std::is_same_v<Old, New>) {
          return false;
        } else if constexpr (std::is_pointer_v<Old>) {
          return pairing.is_same(old_base, new_base);
        } else if constexpr (std::is_same_v<Old, model::Primitive>) {
          return old_base == new_base;
        } else {
          return true;
        }
      },
      before, now);
  if (is_same) return TypeChange::none;
  return is_int32(before) && is_int32(now) ? TypeChange::same_on_wire : TypeChange::different;
}

// Dimensions that an array has: 0 for a scalar, 2 for any number of them.
int dimensions_of(model::ArrayForm form) {
  switch (form) {
    case model::ArrayForm::none:
      return 0;
    case model::ArrayForm::any_length:
    case model::ArrayForm::fixed_length:
    case model::ArrayForm::maximum_length:
      return 1;
    case model::ArrayForm::any_shape:
    case model::ArrayForm::fixed_shape:
      break;
  }
  return 2;
}

}  // namespace

TypeChange compare_types(const model::Type& before, const model::Type& now,
                         const Pairing& pairing) {
  const TypeChange bases = compare_bases(before.base, now.base, pairing);
  if (bases == TypeChange::different || before.container != now.container) {
    return TypeChange::different;
  }
  // The array of a varvalue means nothing (Q07).
  if (std::holds_alternative<model::VarValue>(before.base)) return bases;
  if (dimensions_of(before.array) != dimensions_of(now.array)) return TypeChange::different;
  const bool is_same_length = before.array == now.array && before.dimensions == now.dimensions;
  return is_same_length ? bases : TypeChange::length;
}

std::string text_of(const model::Type& type) {
  const std::string base = std::visit(
      [](const auto& one) -> std::string {
        using Base = std::decay_t<decltype(one)>;
        if constexpr (std::is_pointer_v<Base>) {
          return cut(one->name);
        } else if constexpr (std::is_same_v<Base, model::Primitive>) {
          return std::string(model::name_of(one));
        } else if constexpr (std::is_same_v<Base, model::VarValue>) {
          return "varvalue";
        } else if constexpr (std::is_same_v<Base, model::VarObject>) {
          return "varobject";
        } else {
          return "?";
        }
      },
      type.base);
  return base + type.suffix();
}

std::string in_ticks(std::string_view name) { return '`' + cut(name) + '`'; }

std::string in_ticks(std::string_view scope, std::string_view name) {
  return '`' + cut(scope) + '.' + cut(name) + '`';
}

}  // namespace robdef::breaking
