// SPDX-License-Identifier: Apache-2.0
#include "compiler/plugin/answer.hpp"

#include <algorithm>
#include <array>
#include <cstdint>
#include <functional>
#include <initializer_list>
#include <limits>
#include <nlohmann/json.hpp>
#include <system_error>
#include <utility>

#include "compiler/diagnostics/excerpt.hpp"
#include "compiler/plugin/plugin.hpp"
#include "compiler/system/conventions.hpp"

namespace robdef::plugin {
namespace {

namespace fs = std::filesystem;

using Json = nlohmann::ordered_json;

constexpr int deepest_nesting = 8;

[[noreturn]] void refuse(const std::string& what) { throw PluginError(what); }

std::string in_quotes(std::string_view text) {
  return "`" + printable(text.substr(0, longest_path)) + "`";
}

/// Refuses what would take more memory than its text, before it is there.
class Gate {
 public:
  bool operator()(int depth, Json::parse_event_t, Json&) {
    if (depth > deepest_nesting) refuse("its answer is nested too deeply");
    if (++values_ > most_values) refuse("its answer has too many values");
    return true;
  }

 private:
  std::size_t values_ = 0;
};

Json parse(std::string_view text) {
  if (text.find_first_not_of(" \t\r\n") == std::string_view::npos) refuse("it printed no answer");
  try {
    Gate gate;
    return Json::parse(text, std::ref(gate));
  } catch (const Json::parse_error& error) {
    refuse("its answer is no JSON, at byte " + std::to_string(error.byte) +
           "; what is for people belongs to standard error");
  } catch (const Json::exception& error) {
    refuse("its answer is no JSON: " + printable(error.what()));
  }
}

/// Refuses keys that nobody would read: they are typing errors.
void check_keys(const Json& object, const std::string& where,
                std::initializer_list<std::string_view> known) {
  if (!object.is_object()) refuse(where + " is no object");
  for (const auto& [key, value] : object.items()) {
    if (std::ranges::find(known, key) == known.end()) {
      refuse(where + " has the unknown key " + in_quotes(key));
    }
  }
}

const std::string& text_of(const Json& object, const char* key, const std::string& where) {
  const auto found = object.find(key);
  if (found == object.end()) refuse(where + " has no `" + key + "`");
  if (!found->is_string()) refuse("`" + std::string(key) + "` of " + where + " is no text");
  return found->get_ref<const std::string&>();
}

std::uint32_t number_of(const Json& object, const char* key, const std::string& where) {
  const auto found = object.find(key);
  if (found == object.end()) refuse(where + " has no `" + key + "`");
  const bool is_right = found->is_number_unsigned() &&
                        found->get<std::uint64_t>() <= std::numeric_limits<std::uint32_t>::max();
  if (!is_right) refuse("`" + std::string(key) + "` of " + where + " is no number from 0 on");
  return static_cast<std::uint32_t>(found->get<std::uint64_t>());
}

const Json& list_of(const Json& answer, const char* key) {
  static const Json none = Json::array();
  const auto found = answer.find(key);
  if (found == answer.end()) return none;
  if (!found->is_array()) refuse("`" + std::string(key) + "` of its answer is no list");
  return *found;
}

/// Why a path is none of a file below the output folder; empty when it is.
std::string_view fault_of(const std::string& path) {
  if (path.empty()) return "is empty";
  if (path.size() > longest_path) return "is too long";
  if (fs::path(path).has_root_path()) return "is absolute";
  const bool has_odd_letter = std::ranges::any_of(
      path, [](char c) { return static_cast<unsigned char>(c) < 0x20 || c == '\\' || c == 0x7F; });
  if (has_odd_letter) return "has a backslash or a control character";
  for (std::size_t begin = 0; begin <= path.size();) {
    const std::size_t end = std::min(path.find('/', begin), path.size());
    const std::string_view part(path.data() + begin, end - begin);
    if (part == "..") return "leads out of the output folder";
    if (part.empty() || part == ".") return "has an empty part or `.`";
    if (part.starts_with(".robdef-")) return "is a name that robdef keeps for itself";
    if (const auto fault = system::fault_of_name(part); !fault.empty()) return fault;
    begin = end + 1;
  }
  return "";
}

/// A link in the output folder may lead anywhere.
bool is_below(const fs::path& folder, const std::string& path) {
  std::error_code error;
  fs::path root = fs::weakly_canonical(fs::absolute(folder, error), error);
  if (!root.has_filename()) root = root.parent_path();  // spelled with `/` at its end
  const fs::path file = fs::weakly_canonical(root / path, error);
  if (error) return false;
  return std::mismatch(root.begin(), root.end(), file.begin(), file.end()).first == root.end();
}

void take_file(const Json& file, std::size_t number, const fs::path& folder, FileSet& files) {
  const std::string where = "file " + std::to_string(number) + " of its answer";
  check_keys(file, where, {"path", "content"});
  const std::string& path = text_of(file, "path", where);
  const std::string& content = text_of(file, "content", where);
  const std::string_view fault = fault_of(path);
  if (!fault.empty()) refuse("its path " + in_quotes(path) + " " + std::string(fault));
  if (!is_below(folder, path)) {
    refuse("its path " + in_quotes(path) + " leads out of the output folder by a link");
  }
  if (files.contains(path)) refuse("it makes " + in_quotes(path) + " twice");
  files.add(path, content);
}

/// Refuses a file that would have to be a folder, too.
void check_folders(const FileSet& files) {
  for (const auto& [path, content] : files.files()) {
    for (std::size_t end = path.find('/'); end != std::string::npos;
         end = path.find('/', end + 1)) {
      if (files.contains(path.substr(0, end))) {
        refuse("it makes " + in_quotes(path.substr(0, end)) + " a file and a folder");
      }
    }
  }
}

Span place_of(const Json& at, const std::string& finding, const Sources& sources) {
  const std::string where = "`at` of " + finding;
  check_keys(at, where, {"file", "line", "column", "length"});
  const std::string& name = text_of(at, "file", where);
  const Position position{number_of(at, "line", where), number_of(at, "column", where)};
  const std::uint32_t length = at.contains("length") ? number_of(at, "length", where) : 1;
  for (std::uint32_t index = 0; index < sources.size(); ++index) {
    const Source& source = sources[SourceId{index}];
    if (source.name() != name) continue;
    const auto begin = source.offset(position);
    if (!begin) {
      refuse(where + " is no place of " + in_quotes(name) + ": line " +
             std::to_string(position.line) + ", column " + std::to_string(position.column));
    }
    const std::uint64_t end = std::uint64_t{*begin} + length;
    const auto size = static_cast<std::uint32_t>(source.text().size());
    return {SourceId{index}, *begin, end > size ? size : static_cast<std::uint32_t>(end)};
  }
  refuse(where + " names " + in_quotes(name) + ", which is no file of this run");
}

Finding finding_of(const Json& finding, std::size_t number, const Sources& sources) {
  const std::string where = "finding " + std::to_string(number) + " of its answer";
  check_keys(finding, where, {"level", "message", "at"});
  const std::string& level = text_of(finding, "level", where);
  if (level != "error" && level != "warning") {
    refuse("`level` of " + where + " is neither `error` nor `warning`");
  }
  Finding result;
  result.severity = level == "error" ? Severity::error : Severity::warning;
  result.message = printable(text_of(finding, "message", where));
  if (result.message.empty()) refuse("`message` of " + where + " is empty");
  const auto at = finding.find("at");
  if (at != finding.end() && !at->is_null()) result.at = place_of(*at, where, sources);
  return result;
}

}  // namespace

Answer read_answer(std::string_view text, const Sources& sources, const fs::path& folder) {
  const Json json = parse(text);
  check_keys(json, "its answer", {"files", "findings"});
  if (!json.contains("files") && !json.contains("findings")) {
    refuse("its answer has neither `files` nor `findings`");
  }
  Answer answer;
  std::size_t number = 0;
  for (const Json& file : list_of(json, "files")) take_file(file, ++number, folder, answer.files);
  check_folders(answer.files);
  const Json& findings = list_of(json, "findings");
  if (findings.size() > most_findings) refuse("its answer has too many findings");
  number = 0;
  for (const Json& finding : findings) {
    answer.findings.push_back(finding_of(finding, ++number, sources));
  }
  return answer;
}

}  // namespace robdef::plugin
