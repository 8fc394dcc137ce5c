// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <cstddef>
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
  std::size_t size = 0;         ///< lines that have been read; one above longest_outline: not all
  bool has_long_names = false;  ///< lines with names above longest_name have been left out
};

/// Names of definitions and objects that are read, in bytes, and lines of imports, objects and what
/// they implement: a text must not become many times its size in memory.
inline constexpr std::size_t longest_name = 1024;
inline constexpr std::size_t longest_outline = 65'536;

/// Reads the lines that matter and skips all others; never fails.
DefinitionOutline outline(std::string_view text);

/// The words of the next line of a definition that has any, without comments; a line that ends in a
/// backslash goes on in the next one. Takes it off the text. False at the end.
bool next_line(std::string_view& text, std::vector<std::string_view>& words);

/// One member of an object, as far as it can be told from its line alone.
struct DeclaredMember {
  std::string kind;  ///< `property`, `function`, ...
  std::string name;
  std::string modifiers;  ///< and what else is behind the name
};
/// The members of the objects of a text, by the objects' unqualified names.
std::map<std::string, std::vector<DeclaredMember>> declared_members(std::string_view text);

/// The version of the language that a text declares; empty for none.
std::string declared_version(std::string_view text);

}  // namespace rr::client
