// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <cstdint>
#include <optional>
#include <string>
#include <vector>

#include "rr/rights.hpp"
#include "runtime/cpp/src/endpoint/service_path.hpp"

namespace rr {

/// Which objects a rule is about: `arm.tools[*].gripper`, `arm.**`.
struct PathPattern {
  struct Step {
    std::optional<std::string> name;   ///< nothing: any
    std::optional<std::string> index;  ///< decoded
    bool is_any_index = false;         ///< any, but there must be one
    bool is_any = false;               ///< with an index or without

    [[nodiscard]] bool holds_for(const endpoint::PathSegment& segment) const;
  };
  std::vector<Step> steps;
  bool is_below = false;  ///< what lies below, too

  using Path = std::vector<endpoint::PathSegment>;
  [[nodiscard]] bool holds_for(const Path& path) const;
  /// Whether the path is on the way to an object that this holds for.
  [[nodiscard]] bool leads_through(const Path& path) const;
};

/// A rule that has been read.
struct Rights::Line {
  enum class Who : std::uint8_t { anyone, any_user, user, role };

  bool is_allowed = true;
  Who who = Who::anyone;
  std::string name;  // of the user or role
  std::vector<PathPattern> paths;
  std::vector<std::string> members;  // empty: all
  RightSet access = all_rights;

  [[nodiscard]] bool concerns(const User* user) const;
  [[nodiscard]] RightSet concerned(const PathPattern::Path& path, std::string_view member) const;
};

namespace service {

/// What the lines that concern one user say about a member of an object.
RightSet decide(const std::vector<const Rights::Line*>& lines, std::string_view path,
                std::string_view member);

}  // namespace service
}  // namespace rr
