// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <string_view>

#include "runtime/cpp/src/dynamic/definition_tables.hpp"

/// Members by name, as those who use them and those who offer them say what they want.
namespace rr::dynamic {

/// Throws rr::Error: member_not_found, or member_format_mismatch for a member of another kind.
const MemberTable& need_member(const ObjectTable& object, std::string_view name, MemberKind kind);
/// The same for functions, which are generator functions or not.
const MemberTable& need_function(const ObjectTable& object, std::string_view name,
                                 bool is_generator);
/// Throws rr::Error (member_not_found).
MemberDescription describe_member(const ObjectTable& object, std::string_view name);
/// All, in the order of the definition.
std::vector<MemberDescription> describe_members(const ObjectTable& object);

}  // namespace rr::dynamic
