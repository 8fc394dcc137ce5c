// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <map>
#include <string>
#include <string_view>
#include <vector>

namespace rr::client {

/// What a client must know of a definition that it has got as text and may not have been compiled
/// with: what it imports, and which objects implement which.
struct DefinitionOutline {
  std::string name;
  std::vector<std::string> imports;
  /// Qualified names of what each object implements, by its unqualified name.
  std::map<std::string, std::vector<std::string>> objects;
};

/// Reads the lines that matter and skips all others; never fails.
DefinitionOutline outline(std::string_view text);

/// The version of the language that a text declares; empty for none.
std::string declared_version(std::string_view text);

}  // namespace rr::client
