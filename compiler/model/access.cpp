// SPDX-License-Identifier: Apache-2.0
// What modifiers mean, and which kind of member knows which (06, section 6).
#include <algorithm>
#include <initializer_list>
#include <string_view>
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
  const auto has = [&](std::string_view name) {
    return knows_modifier(kind, name) &&
           std::any_of(modifiers.begin(), modifiers.end(), [name](const Modifier& modifier) {
             return modifier.name == name && modifier.arguments.empty();
           });
  };
  Access access;
  access.is_readonly = has("readonly");
  access.is_writeonly = has("writeonly") && !access.is_readonly;
  access.is_unreliable = has("unreliable");
  access.is_nolock = has("nolock");
  access.is_nolockread = has("nolockread") && !access.is_nolock;
  access.is_perclient = has("perclient");
  access.is_urgent = has("urgent");
  return access;
}

}  // namespace robdef::model
