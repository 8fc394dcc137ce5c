// SPDX-License-Identifier: Apache-2.0
#include "compiler/docs/uses.hpp"

#include <algorithm>
#include <type_traits>
#include <variant>

namespace robdef::docs {

Uses::Uses(const model::Model& model) {
  for (const model::Definition* definition : by_name(model)) read(*definition);
}

void Uses::read(const model::Definition& definition) {
  for (const model::Definition* import : definition.imports) {
    importers_[import].push_back({&definition, ""});
  }
  for (const model::Record& record : definition.records) {
    for (const model::Field& field : record.fields) {
      use(field.type, {&definition, record.name + "." + field.name});
    }
  }
  for (const model::Object& object : definition.objects) {
    for (const model::Object* base : object.implements) {
      implementers_[base].push_back({&definition, object.name});
    }
    for (const model::Member& member : object.members) {
      members_[&object].insert(member.name);
      const Place place{&definition, object.name + "." + member.name};
      use(member.type, place);
      for (const model::Parameter& parameter : member.parameters) use(parameter.type, place);
      if (member.generator_parameter) use(member.generator_parameter->type, place);
    }
  }
}

void Uses::use(const model::Type& type, const Place& place) {
  std::visit(
      [&](const auto& base) {
        if constexpr (std::is_pointer_v<std::decay_t<decltype(base)>>) {
          std::vector<Place>& places = uses_[base];
          if (places.empty() || !(places.back() == place)) places.push_back(place);
        }
      },
      type.base);
}

const std::vector<Place>& Uses::find(const Table& table, const void* key) {
  static const std::vector<Place> none;
  const auto found = table.find(key);
  return found == table.end() ? none : found->second;
}

const std::vector<Place>& Uses::of(const void* declaration) const {
  return find(uses_, declaration);
}
const std::vector<Place>& Uses::implementers_of(const model::Object& object) const {
  return find(implementers_, &object);
}
const std::vector<Place>& Uses::importers_of(const model::Definition& definition) const {
  return find(importers_, &definition);
}

bool Uses::has_member(const model::Object* object, const std::string& name) const {
  const auto found = members_.find(object);
  return found != members_.end() && found->second.contains(name);
}

std::vector<const model::Object*> Uses::origins_of(const model::Object& object,
                                                   const model::Member& member) const {
  // An object names all that it implements, those behind others, too.
  std::vector<const model::Object*> found;
  for (const model::Object* base : object.implements) {
    const bool is_handed_on = std::ranges::any_of(
        base->implements, [&](const auto* one) { return has_member(one, member.name); });
    if (has_member(base, member.name) && !is_handed_on) found.push_back(base);
  }
  return found;
}

}  // namespace robdef::docs
