// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <iosfwd>
#include <rr/dynamic.hpp>
#include <string>
#include <string_view>
#include <vector>

#include "cli/live/object_path.hpp"

namespace robdef::live {

/// The type of an object, and the definitions that have it.
struct TypeAt {
  rr::dynamic::Definitions types;
  std::string name;  ///< qualified

  [[nodiscard]] std::vector<rr::dynamic::MemberDescription> members() const {
    return types.members(name);
  }
};

/// Of the object at a path, found in the definitions; the service is asked only for what lies
/// behind a varobject. Throws rr::Error.
TypeAt object_type_at(const rr::dynamic::Object& root, const ObjectPath& path);

/// Prints outlines of all definitions of a service; with a path those of one object or member.
/// Throws rr::Error.
void describe_text(const rr::dynamic::Object& root, std::string_view path, std::ostream& out);
/// The same as one JSON object: the objects that are found by the types of objrefs, with their
/// members, and the structs, pods, namedarrays and enums that these use.
void describe_json(const rr::dynamic::Object& root, std::string_view path, std::ostream& out);
/// The declarations of an object's members, a line each.
void list_members(const rr::dynamic::Object& root, const ObjectPath& path, std::ostream& out);

}  // namespace robdef::live
