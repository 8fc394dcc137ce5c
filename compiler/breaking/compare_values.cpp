// SPDX-License-Identifier: Apache-2.0
// Types of values, constants, enums.
#include <array>
#include <charconv>
#include <map>
#include <variant>

#include "compiler/breaking/comparison.hpp"
#include "compiler/breaking/types.hpp"

namespace robdef::breaking {
namespace {

using model::Constant;
using model::EnumValue;

std::string was(const model::Type& before) { return ", it was " + in_ticks(text_of(before)); }

template <class Value>
bool is_same(const Constant& before, const Constant& now) {
  const auto* const one = std::get_if<Value>(&before.value);
  const auto* const other = std::get_if<Value>(&now.value);
  return one != nullptr && other != nullptr && *one == *other;
}

bool is_same_type(const Constant& before, const Constant& now) {
  if (before.is_struct != now.is_struct) return false;
  return before.is_struct || before.type.is_same_as(now.type);
}

// Which constant each field of a struct constant stands for.
std::map<std::string_view, std::string_view> parts_of(const Constant& constant) {
  std::map<std::string_view, std::string_view> parts;
  for (const model::StructValueField& field :
       std::get<std::vector<model::StructValueField>>(constant.value)) {
    if (field.constant != nullptr) parts.try_emplace(field.field, field.constant->name);
  }
  return parts;
}

// What a struct constant's parts are worth is a matter of theirs.
bool is_same_value(const Constant& before, const Constant& now) {
  if (before.is_struct) return parts_of(before) == parts_of(now);
  return is_same<model::Number>(before, now) || is_same<std::string>(before, now) ||
         is_same<std::vector<model::Number>>(before, now);
}

std::string number_text(const model::Number& number) {
  return std::visit(
      [](const auto value) {
        std::array<char, 64> text{};
        return std::string(text.data(),
                           std::to_chars(text.data(), text.data() + text.size(), value).ptr);
      },
      number);
}

std::string value_text(const Constant& before, const Constant& now) {
  const auto* const old_number = std::get_if<model::Number>(&before.value);
  const auto* const new_number = std::get_if<model::Number>(&now.value);
  if (old_number == nullptr || new_number == nullptr) return " has another value";
  return " is " + number_text(*new_number) + ", it was " + number_text(*old_number);
}

}  // namespace

bool compare_value(const Subject& subject, const model::Type& before, const model::Type& now,
                   const Comparison& comparison) {
  const std::string type = subject.text + " is " + in_ticks(text_of(now)) + was(before);
  switch (compare_types(before, now, comparison.pairing)) {
    case TypeChange::none:
      return false;
    case TypeChange::same_on_wire:
      comparison.changes.add(Code::R0744, subject.before, subject.now, type);
      return true;
    case TypeChange::length:
      comparison.changes.add(Code::R0706, subject.before, subject.now, type)
          .help("add a member or field of the new type, and keep this one");
      return true;
    case TypeChange::different:
      break;
  }
  comparison.changes.add(Code::R0705, subject.before, subject.now, type)
      .help("add a member or field of the new type, and keep this one");
  return true;
}

void compare_constants(std::string_view scope, Span now_scope, const std::vector<Constant>& before,
                       const std::vector<Constant>& now, const Comparison& comparison) {
  const auto pairs = pair_up(before, now, [](const Constant&) { return std::uint64_t{0}; });
  for (const Constant* const constant : pairs.removed) {
    comparison.changes.add(Code::R0743, constant->span, now_scope,
                           "constant " + in_ticks(scope, constant->name) + " is gone");
  }
  for (const auto& pair : pairs.kept) {
    const std::string name = "constant " + in_ticks(scope, pair.now->name);
    if (!is_same_type(*pair.before, *pair.now)) {
      const auto text = [](const Constant& one) {
        return one.is_struct ? std::string("struct") : text_of(one.type);
      };
      comparison.changes.add(
          Code::R0745, pair.before->span, pair.now->span,
          name + " is " + in_ticks(text(*pair.now)) + ", it was " + in_ticks(text(*pair.before)));
    } else if (!is_same_value(*pair.before, *pair.now)) {
      comparison.changes
          .add(Code::R0773, pair.before->span, pair.now->span,
               name + value_text(*pair.before, *pair.now))
          .help("give the new value a name of its own");
    }
  }
}

void compare_enum(const model::Enum& before, const model::Enum& now, const Comparison& comparison) {
  // A name that has gone while its number has a name that is new: renamed.
  const auto pairs = pair_up(before.values, now.values, [](const EnumValue& value) {
    return std::uint64_t{static_cast<std::uint32_t>(value.value)} + 1;
  });
  for (const auto& pair : pairs.renamed) {
    comparison.changes.add(Code::R0742, pair.before->span, pair.now->span,
                           "value " + in_ticks(before.name, pair.before->name) + " is now called " +
                               in_ticks(pair.now->name));
  }
  for (const EnumValue* const value : pairs.removed) {
    comparison.changes
        .add(Code::R0772, value->span, now.span,
             "value " + in_ticks(before.name, value->name) + " is gone")
        .help("keep the name for as long as programs may send " + std::to_string(value->value));
  }
  for (const auto& pair : pairs.kept) {
    if (pair.before->value == pair.now->value) continue;
    comparison.changes
        .add(Code::R0771, pair.before->span, pair.now->span,
             "value " + in_ticks(now.name, pair.now->name) + " is " +
                 std::to_string(pair.now->value) + ", it was " + std::to_string(pair.before->value))
        .help("write `" + pair.now->name.substr(0, 100) + " = " +
              std::to_string(pair.before->value) + "`");
  }
}

}  // namespace robdef::breaking
