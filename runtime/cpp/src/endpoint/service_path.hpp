// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <optional>
#include <string>
#include <string_view>
#include <vector>

/// Paths of objects: `service.objref[index].objref` (07, section 3).
namespace rr::endpoint {

/// One step of a path.
struct PathSegment {
  std::string name;
  std::optional<std::string> index;  ///< decoded

  bool operator==(const PathSegment&) const = default;
};

/// Nothing when the text is no path.
std::optional<std::vector<PathSegment>> parse_path(std::string_view path);

/// An index as it stands between the brackets: all bytes but ASCII letters and digits become `%`
/// and two lower-case hexadecimal digits.
std::string escape_index(std::string_view index);

/// The one spelling of a path that is used as its name.
std::string canonical_path(const std::vector<PathSegment>& segments);

/// True for `path` itself and for what lies below it.
bool is_at_or_below(std::string_view path, std::string_view ancestor);

}  // namespace rr::endpoint
