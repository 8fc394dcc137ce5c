// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <map>
#include <set>
#include <string>
#include <string_view>
#include <vector>

namespace rr::client {

/// What a declaration means on the wire, in one way of writing it: types qualified, no blanks but
/// those that part words.
struct Shape {
  std::string text;             ///< `property double[]`, `function void(int32 a,m.Pose b)`
  std::set<std::string> types;  ///< qualified names of the records and enums in it
};

/// The members of objects, and the records and enums, of a definition, as far as its text tells.
struct DefinitionShape {
  std::map<std::string, std::map<std::string, Shape, std::less<>>, std::less<>> objects;
  /// structs, pods and namedarrays; those of structs in the order of the fields' names
  std::map<std::string, Shape, std::less<>> records;
  /// The numbers of an enum's names.
  std::map<std::string, std::map<std::string, long long, std::less<>>, std::less<>> enums;
};

/// Reads a text. What is not in `wanted`, unless that is null, is left out: a text of somebody else
/// then takes no more memory than one's own. Never fails.
DefinitionShape shape_of(std::string_view text, const DefinitionShape* wanted = nullptr);

}  // namespace rr::client
