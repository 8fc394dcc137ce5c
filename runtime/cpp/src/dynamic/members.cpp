// SPDX-License-Identifier: Apache-2.0
#include "runtime/cpp/src/dynamic/members.hpp"

#include <array>
#include <string>
#include <vector>

#include "compiler/diagnostics/spelling.hpp"
#include "rr/error.hpp"
#include "runtime/cpp/src/dynamic/stub.hpp"

namespace rr::dynamic {
namespace {

std::string_view name_of(MemberKind kind) {
  constexpr std::array<std::string_view, 8> names = {"property", "function", "event", "objref",
                                                     "pipe",     "callback", "wire",  "memory"};
  return names.at(static_cast<std::size_t>(kind));
}

[[noreturn]] void refuse_member(const MemberTable& member, std::string_view expected,
                                std::string_view is) {
  throw Error(
      ErrorCode::member_format_mismatch,
      subject_of(member.name) + ": expected " + std::string(expected) + ", got " + std::string(is));
}

/// Of names that an object does not have, with the one that was probably meant.
[[noreturn]] void refuse_name(const ObjectTable& object, std::string_view kind,
                              std::string_view name) {
  std::vector<std::string_view> names;
  for (const MemberTable& member : object.members) names.push_back(member.name);
  const std::string_view near = robdef::nearest(name, names);
  throw Error(
      ErrorCode::member_not_found,
      "`" + object.name + "` has no " + std::string(kind) + " `" + std::string(name) + "`" +
          (near.empty() || near == name ? "" : "; did you mean `" + std::string(near) + "`?"));
}

}  // namespace

const MemberTable& need_member(const ObjectTable& object, std::string_view name, MemberKind kind) {
  const MemberTable* const found = object.find(name);
  if (found == nullptr) refuse_name(object, name_of(kind), name);
  const MemberKind is = object.wire(*found).kind;
  if (is != kind) refuse_member(*found, name_of(kind), name_of(is));
  return *found;
}

const MemberTable& need_function(const ObjectTable& object, std::string_view name,
                                 bool is_generator) {
  constexpr std::string_view generator = "generator function";
  const MemberTable& member = need_member(object, name, MemberKind::function);
  const bool is = object.wire(member).generator != GeneratorForm::none;
  if (is && !is_generator) refuse_member(member, "plain function", generator);
  if (!is && is_generator) refuse_member(member, generator, "plain function");
  return member;
}

MemberDescription describe_member(const ObjectTable& object, std::string_view name) {
  if (const MemberTable* const found = object.find(name)) {
    return object.tables->describe(object, *found);
  }
  refuse_name(object, "member", name);
}

std::vector<MemberDescription> describe_members(const ObjectTable& object) {
  std::vector<MemberDescription> members;
  for (const MemberTable& member : object.members) {
    members.push_back(object.tables->describe(object, member));
  }
  return members;
}

}  // namespace rr::dynamic
