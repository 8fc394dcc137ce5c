// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <string>
#include <vector>

namespace robdef::docs {

/// Something that the search box finds. Plain text.
struct Found {
  std::string kind;    ///< `struct`, `property`, ...
  std::string name;    ///< `Arm.move_to`
  std::string anchor;  ///< in the page; empty for the definition
  std::string words;   ///< documentation, on one line
};

/// The search index of a page: a JSON object on one line. It may stand in a `<script>`, since none
/// of the characters that end one are in it.
///
///   {"page": "a.html", "name": "a", "entries": [[kind, name, anchor, words]]}
std::string search_index(const std::string& page, const std::string& name,
                         const std::vector<Found>& entries);

}  // namespace robdef::docs
