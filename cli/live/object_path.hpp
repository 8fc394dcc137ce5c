// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <optional>
#include <rr/dynamic.hpp>
#include <string>
#include <string_view>
#include <vector>

/// Where a member is, as a user writes it: `lights[0].lamp.color`, from the service's root object.
/// What stands between the brackets is the index, a number or a text; `%` and two hexadecimal
/// digits stand for one byte, so that every text can be written: `%5d` is `]`, `%25` is `%`.
namespace robdef::live {

struct PathStep {
  std::string name;
  std::optional<std::string> index;

  bool operator==(const PathStep&) const = default;
};
using ObjectPath = std::vector<PathStep>;

/// A member, or an object, of the object at a path.
struct MemberPath {
  ObjectPath object;
  std::string member;
};

/// Throws rr::Error (invalid_argument).
[[noreturn]] void refuse(const std::string& what);

/// Empty text: the root. Throws rr::Error (invalid_argument) for what is no path.
ObjectPath parse_object_path(std::string_view text);
/// Throws rr::Error (invalid_argument) for what is no path, or ends with an index.
MemberPath parse_member_path(std::string_view text);
/// The text of which parse_object_path makes the same again.
std::string text_of(const ObjectPath& path);

/// Asks the service for the objects on the way. Throws rr::Error, naming the member that is no
/// objref, or the index that it needs.
rr::dynamic::Object object_at(rr::dynamic::Object object, const ObjectPath& path);

}  // namespace robdef::live
