// SPDX-License-Identifier: Apache-2.0
#include "compiler/backends/implements.hpp"

#include <algorithm>

namespace robdef {

using model::Member;
using model::MemberKind;
using model::Object;

const Object* origin(const Object& object, const std::string& name) {
  const Object* found = nullptr;
  for (const Object* base : object.implements) {
    const bool has_it =
        std::ranges::find(base->members, name, &Member::name) != base->members.end();
    if (!has_it) continue;
    const Object* inner = origin(*base, name);
    const Object* root = inner == nullptr ? base : inner;
    if (found != nullptr && found != root) return nullptr;
    found = root;
  }
  return found;
}

std::string plural_of(const Member& member) {
  if (member.generator != model::GeneratorForm::none) return "generator functions";
  const bool is_contained = member.type.container != model::ContainerForm::none;
  if (member.kind == MemberKind::memory && is_contained) return "memories in a list or map";
  return std::string(model::name_of(member.kind)) + "s";
}

std::string full_name(const Object& object, const Member& member) {
  for (const Object* base : object.implements) {
    const bool has_it =
        std::ranges::find(base->members, member.name, &Member::name) != base->members.end();
    if (has_it) return full_name(*base, member);
  }
  return object.qualified_name() + "." + member.name;
}

void report_unserved(const Member& member, std::string_view language, Report& report) {
  report.add(Code::R0904, member.span,
             "the " + std::string(language) + " runtime does not serve " + plural_of(member) +
                 "; `" + member.name + "` is left out");
}

}  // namespace robdef
