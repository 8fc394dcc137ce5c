// SPDX-License-Identifier: Apache-2.0
#include "compiler/driver/explain.hpp"

#include <fmt/format.h>

#include <algorithm>
#include <cctype>
#include <string_view>
#include <utility>

#include "compiler/diagnostics/levels.hpp"
#include "compiler/output/json.hpp"

namespace robdef {

namespace {

bool is_same_name(std::string_view left, std::string_view right) {
  return std::equal(left.begin(), left.end(), right.begin(), right.end(), [](char a, char b) {
    return std::toupper(static_cast<unsigned char>(a)) ==
           std::toupper(static_cast<unsigned char>(b));
  });
}

bool has(const WarningGroup& group, const CodeEntry& entry) {
  if (!group.codes.empty()) return std::ranges::find(group.codes, entry.code) != group.codes.end();
  return entry.severity == Severity::warning && !entry.name.starts_with("R07");
}

std::string_view name_of(Severity severity) {
  return severity == Severity::error ? "error" : "warning";
}

}  // namespace

std::vector<const CodeEntry*> find_entries(const std::vector<std::string>& names,
                                           std::string& unknown) {
  std::vector<const CodeEntry*> found;
  for (const std::string& name : names) {
    const std::size_t before = found.size();
    for (const CodeEntry& entry : code_entries()) {
      const bool is_rule = !entry.rule.empty() && is_same_name(entry.rule, name);
      if (is_rule || is_same_name(entry.name, name)) found.push_back(&entry);
    }
    for (const WarningGroup& group : warning_groups()) {
      if (group.name != name) continue;
      for (const CodeEntry& entry : code_entries()) {
        if (has(group, entry)) found.push_back(&entry);
      }
    }
    if (found.size() == before) {
      unknown = name;
      return found;
    }
  }
  return found;
}

std::string entry_list(const std::vector<const CodeEntry*>& entries) {
  std::string text;
  for (const CodeEntry* entry : entries) {
    text += fmt::format("{}  {:<4} {:<8} {}\n", entry->name, entry->rule, name_of(entry->severity),
                        entry->summary);
  }
  return text;
}

std::string group_list() {
  std::string text = "\n";
  for (const WarningGroup& group : warning_groups()) {
    text += fmt::format("{:<12} {}", group.name, group.summary);
    for (const Code code : group.codes) {
      text += fmt::format("{}{}", code == group.codes.front() ? ": " : ", ", entry_of(code).name);
    }
    text += '\n';
  }
  return text;
}

std::string entry_text(const std::vector<const CodeEntry*>& entries) {
  std::string text;
  for (const CodeEntry* entry : entries) {
    if (!text.empty()) text += "\n";
    const std::string rule = entry->rule.empty() ? "" : fmt::format(" (rule {})", entry->rule);
    text += fmt::format("{}[{}]{}: {}\n\n{}\n", name_of(entry->severity), entry->name, rule,
                        entry->summary, entry->explanation);
  }
  return text;
}

std::string entry_json(const std::vector<const CodeEntry*>& entries) {
  JsonWriter json;
  json.begin_array();
  for (const CodeEntry* entry : entries) {
    json.begin_object();
    json.member("code", entry->name);
    json.member("rule", entry->rule);
    json.member("severity", name_of(entry->severity));
    json.member("summary", entry->summary);
    json.member("explanation", entry->explanation);
    json.end_object();
  }
  json.end_array();
  return std::move(json).text();
}

}  // namespace robdef
