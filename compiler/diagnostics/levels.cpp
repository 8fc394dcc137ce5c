// SPDX-License-Identifier: Apache-2.0
#include "compiler/diagnostics/levels.hpp"

#include <algorithm>

#include "compiler/diagnostics/spelling.hpp"

namespace robdef {
namespace {

bool is_warning(const CodeEntry& entry) { return entry.severity == Severity::warning; }

// Changes between versions have options of their own.
bool is_of_versions(const CodeEntry& entry) { return entry.name.starts_with("R07"); }

}  // namespace

const std::vector<WarningGroup>& warning_groups() {
  static const std::vector<WarningGroup> groups = {
      {"warnings", "all warnings", {}},
      {"outdated",
       "forms of earlier versions of the language",
       {Code::R0136, Code::R0141, Code::R0142, Code::R0324}},
      {"style", "signs that are left over", {Code::R0143, Code::R0144, Code::R0145}},
      {"unused",
       "what has no effect",
       {Code::R0146, Code::R0147, Code::R0421, Code::R0422, Code::R0521, Code::R0610, Code::R0611,
        Code::R0625}},
      {"values",
       "constants and arguments that mean something else than they seem to",
       {Code::R0321, Code::R0322, Code::R0323, Code::R0325, Code::R0326, Code::R0328, Code::R0612}},
      {"portability",
       "what other tools refuse, or read in another way",
       {Code::R0221, Code::R0222, Code::R0223, Code::R0327, Code::R0621, Code::R0622, Code::R0623,
        Code::R0624}},
      {"target", "what a language changes or leaves out", {Code::R0903, Code::R0904, Code::R1002}},
  };
  return groups;
}

std::optional<Level> level_of(std::string_view word) {
  if (word == "allow") return Level::allow;
  if (word == "warn") return Level::warn;
  if (word == "deny") return Level::deny;
  return std::nullopt;
}

std::string Levels::set(std::string_view name, Level level) {
  if (const CodeEntry* const entry = find_code(upper_case(name))) {
    const std::string code = "`" + std::string(entry->name) + "`";
    if (is_of_versions(*entry)) return code + " is of `robdef breaking`";
    if (!is_warning(*entry)) return code + " is an error; only warnings can be turned off";
    codes_[entry->code] = level;
    return "";
  }
  std::vector<std::string_view> names;
  for (const WarningGroup& group : warning_groups()) {
    if (group.name == name) {
      groups_[&group] = level;
      return "";
    }
    names.push_back(group.name);
  }
  for (const CodeEntry& entry : code_entries()) {
    if (is_warning(entry)) names.push_back(entry.name);
  }
  const std::string_view near = nearest(name, names);
  return "there is no code or group `" + std::string(name) + "`; " +
         (near.empty() ? "see `robdef explain --list`"
                       : "did you mean `" + std::string(near) + "`?");
}

std::optional<Level> Levels::find(Code code) const {
  if (const auto found = codes_.find(code); found != codes_.end()) return found->second;
  std::optional<Level> of_all;
  for (const auto& [group, level] : groups_) {
    if (std::ranges::find(group->codes, code) != group->codes.end()) return level;
    if (group->codes.empty()) of_all = level;
  }
  return of_all;
}

void set_levels(Report& report, const std::vector<const Levels*>& given) {
  for (const CodeEntry& entry : code_entries()) {
    if (!is_warning(entry) || is_of_versions(entry)) continue;
    for (const Levels* const levels : given) {
      const std::optional<Level> level = levels->find(entry.code);
      if (!level) continue;
      report.set_level(entry.code, *level);
      break;
    }
  }
}

}  // namespace robdef
