// SPDX-License-Identifier: Apache-2.0
// Finds which new declaration is which old one: by name, else by what it looks like. Names are made
// numbers once, so that comparing types costs nothing however long the names are.
#include "compiler/breaking/pairing.hpp"

#include <functional>
#include <type_traits>
#include <utility>
#include <variant>

namespace robdef::breaking {
namespace {

// Collects numbers into one. Two looks with one number would only make a change be called a
// renaming.
class Mixer {
 public:
  void add(std::uint64_t number) {
    number_ ^= number + 0x9E3779B97F4A7C15ULL + (number_ << 6U) + (number_ >> 2U);
    number_ *= 0xFF51AFD7ED558CCDULL;
    number_ ^= number_ >> 33U;
  }
  void add(std::string_view text) { add(std::hash<std::string_view>()(text)); }
  // 0 means: no look.
  [[nodiscard]] std::uint64_t number() const { return number_ == 0 ? 1 : number_; }

 private:
  std::uint64_t number_ = 0x51ED270B35A3C2D1ULL;
};

template <class Enumeration>
std::uint64_t number_in(Enumeration value) {
  return static_cast<std::uint64_t>(value);
}

}  // namespace

Pairing::Pairing(const model::Model& before, const model::Model& now, bool now_is_partial) {
  pair_definitions(before, now, now_is_partial);
  for (const DefinitionPair& pair : definitions_) number_names(pair);
  for (DefinitionPair& pair : definitions_) pair_declarations(pair);
}

void Pairing::pair_definitions(const model::Model& before, const model::Model& now,
                               bool now_is_partial) {
  std::vector<const model::Definition*> missing;
  for (const auto& definition : before.definitions()) {
    if (before.find(definition->name) != definition.get()) continue;
    if (const model::Definition* const same = now.find(definition->name)) {
      definitions_.push_back({definition.get(), same, false, {}, {}, {}});
    } else if (!definition->is_import) {
      missing.push_back(definition.get());
    }
  }
  std::vector<const model::Definition*> fresh;
  for (const auto& definition : now.definitions()) {
    if (now.find(definition->name) != definition.get() || definition->is_import) continue;
    if (before.find(definition->name) == nullptr) fresh.push_back(definition.get());
  }
  if (missing.size() == 1 && fresh.size() == 1) {
    definitions_.push_back({missing.front(), fresh.front(), true, {}, {}, {}});
  } else if (!now_is_partial || definitions_.empty()) {
    removed_ = std::move(missing);
  }
}

void Pairing::number_names(const DefinitionPair& pair) {
  std::unordered_map<std::string_view, std::uint64_t> numbers;
  const auto number = [&](const auto& things) {
    for (const auto& thing : things) {
      const auto [place, is_new] = numbers.try_emplace(thing.name, next_number_);
      if (is_new) ++next_number_;
      number_of_.emplace(&thing, place->second);
    }
  };
  for (const model::Definition* side : {pair.before, pair.now}) {
    number(side->records);
    number(side->enums);
    number(side->objects);
  }
}

template <class Thing>
void Pairing::note(const Pairs<Thing>& pairs) {
  for (const auto& pair : pairs.kept) before_of_.emplace(pair.now, pair.before);
  for (const auto& pair : pairs.renamed) before_of_.emplace(pair.now, pair.before);
}

void Pairing::pair_declarations(DefinitionPair& pair) {
  const auto look = [this](const auto& thing) { return shape(thing); };
  pair.records = pair_up(pair.before->records, pair.now->records, look);
  pair.enums = pair_up(pair.before->enums, pair.now->enums, look);
  pair.objects = pair_up(pair.before->objects, pair.now->objects, look);
  note(pair.records);
  note(pair.enums);
  note(pair.objects);
}

bool Pairing::is_same(const void* before, const void* now) const {
  const auto found = before_of_.find(now);
  return found != before_of_.end() && found->second == before;
}

const void* Pairing::before(const void* now) const {
  const auto found = before_of_.find(now);
  return found == before_of_.end() ? nullptr : found->second;
}

std::uint64_t Pairing::shape(const model::Type& type) const {
  Mixer mixer;
  mixer.add(type.base.index());
  std::visit(
      [&](const auto& base) {
        using Base = std::decay_t<decltype(base)>;
        if constexpr (std::is_same_v<Base, model::Primitive>) {
          mixer.add(number_in(base));
        } else if constexpr (std::is_pointer_v<Base>) {
          const auto found = number_of_.find(base);
          mixer.add(found == number_of_.end() ? 0 : found->second);
        }
      },
      type.base);
  mixer.add(number_in(type.array));
  for (const std::uint32_t dimension : type.dimensions) mixer.add(dimension);
  mixer.add(number_in(type.container));
  return mixer.number();
}

std::uint64_t Pairing::shape(const model::Record& record) const {
  if (record.fields.empty()) return 0;
  Mixer mixer;
  mixer.add(number_in(record.kind));
  for (const model::Field& field : record.fields) {
    mixer.add(field.name);
    mixer.add(shape(field.type));
  }
  return mixer.number();
}

std::uint64_t Pairing::shape(const model::Enum& enumeration) const {
  if (enumeration.values.empty()) return 0;
  Mixer mixer;
  for (const model::EnumValue& value : enumeration.values) {
    mixer.add(value.name);
    mixer.add(static_cast<std::uint32_t>(value.value));
  }
  return mixer.number();
}

std::uint64_t Pairing::shape(const model::Object& object) const {
  if (object.members.empty()) return 0;
  Mixer mixer;
  for (const model::Member& member : object.members) {
    mixer.add(member.name);
    mixer.add(shape_of(member, *this));
  }
  return mixer.number();
}

std::uint64_t shape_of(const model::Member& member, const Pairing& pairing) {
  Mixer mixer;
  mixer.add(number_in(member.kind));
  mixer.add(pairing.shape(member.type));
  for (const model::Parameter& parameter : member.parameters) {
    mixer.add(parameter.name);
    mixer.add(pairing.shape(parameter.type));
  }
  mixer.add(number_in(member.generator));
  if (member.generator_parameter) mixer.add(pairing.shape(member.generator_parameter->type));
  mixer.add(number_in(member.index));
  return mixer.number();
}

}  // namespace robdef::breaking
