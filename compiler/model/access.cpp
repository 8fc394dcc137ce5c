// SPDX-License-Identifier: Apache-2.0
// What modifiers mean, and which kind of member knows which (06, section 6).
#include <algorithm>
#include <initializer_list>
#include <string_view>
#include <utility>
#include <vector>

#include "compiler/model/resolve.hpp"

namespace robdef::model {
namespace {

bool is_one_of(std::string_view word, std::initializer_list<std::string_view> words) {
  return std::find(words.begin(), words.end(), word) != words.end();
}

}  // namespace

bool knows_modifier(MemberKind kind, std::string_view modifier) {
  switch (kind) {
    case MemberKind::property:
      return is_one_of(modifier,
                       {"readonly", "writeonly", "nolock", "nolockread", "perclient", "urgent"});
    case MemberKind::function:
      return is_one_of(modifier, {"nolock", "urgent"});
    case MemberKind::event:
    case MemberKind::callback:
      return modifier == "urgent";
    case MemberKind::objref:
      return false;
    case MemberKind::pipe:
      return is_one_of(modifier, {"readonly", "writeonly", "unreliable", "nolock"});
    case MemberKind::wire:
      return is_one_of(modifier, {"readonly", "writeonly", "nolock"});
    case MemberKind::memory:
      return is_one_of(modifier, {"readonly", "writeonly", "nolock", "nolockread"});
  }
  return false;
}

Access access_of(MemberKind kind, const std::vector<Modifier>& modifiers) {
  constexpr std::pair<std::string_view, bool Access::*> meanings[] = {
      {"readonly", &Access::is_readonly},     {"writeonly", &Access::is_writeonly},
      {"unreliable", &Access::is_unreliable}, {"nolock", &Access::is_nolock},
      {"nolockread", &Access::is_nolockread}, {"perclient", &Access::is_perclient},
      {"urgent", &Access::is_urgent}};
  Access access;
  for (const Modifier& modifier : modifiers) {
    if (!modifier.arguments.empty() || !knows_modifier(kind, modifier.name)) continue;
    for (const auto& [name, flag] : meanings) {
      if (modifier.name == name) access.*flag = true;
    }
  }
  if (access.is_readonly) access.is_writeonly = false;
  if (access.is_nolock) access.is_nolockread = false;
  return access;
}

}  // namespace robdef::model
