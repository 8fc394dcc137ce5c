// SPDX-License-Identifier: Apache-2.0
#include <algorithm>

#include "compiler/backends/backend.hpp"

namespace robdef {

bool Abilities::serve(const model::Member& member) const {
  switch (member.kind) {
    case model::MemberKind::property:
      return properties;
    case model::MemberKind::function:
      return member.generator == model::GeneratorForm::none ? functions : generators;
    case model::MemberKind::event:
      return events;
    case model::MemberKind::objref:
      return objrefs;
    case model::MemberKind::pipe:
      return pipes;
    case model::MemberKind::callback:
      return callbacks;
    case model::MemberKind::wire:
      return wires;
    case model::MemberKind::memory:
      return member.type.container == model::ContainerForm::none ? memories : contained_memories;
  }
  return false;
}

bool Abilities::must_implement(const model::Object& object) const {
  return std::ranges::any_of(object.members, [&](const model::Member& member) {
    switch (member.kind) {
      case model::MemberKind::property:
      case model::MemberKind::function:
      case model::MemberKind::objref:
      case model::MemberKind::memory:
        return serve(member);
      default:
        return false;
    }
  });
}

}  // namespace robdef
