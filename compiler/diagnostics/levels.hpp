// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <map>
#include <optional>
#include <string>
#include <string_view>
#include <vector>

#include "compiler/diagnostics/report.hpp"

/// What users choose about warnings, by code or by group.
namespace robdef {

/// Several warnings under one name.
struct WarningGroup {
  std::string_view name;
  std::string_view summary;  ///< one line
  std::vector<Code> codes;   ///< empty: all warnings
};

/// All groups; the first is `warnings`, and each other warning is in one of the rest.
const std::vector<WarningGroup>& warning_groups();

/// `allow`, `warn` or `deny`; nothing for another word.
std::optional<Level> level_of(std::string_view word);

/// Levels that were given at one place: the command line, or a project file.
class Levels {
 public:
  /// `name` is a code, in either case, or a group. Returns what is wrong with it, with help for a
  /// misspelt one; empty when nothing is.
  [[nodiscard]] std::string set(std::string_view name, Level level);
  /// What is said about a code itself, else about its group, else about all warnings.
  [[nodiscard]] std::optional<Level> find(Code code) const;

 private:
  std::map<Code, Level> codes_;
  std::map<const WarningGroup*, Level> groups_;
};

/// Gives the levels to a report: the first of `given` that says something about a code counts.
void set_levels(Report& report, const std::vector<const Levels*>& given);

}  // namespace robdef
