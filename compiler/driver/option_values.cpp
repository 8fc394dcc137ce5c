// SPDX-License-Identifier: Apache-2.0
#include "compiler/driver/option_values.hpp"

#include <algorithm>
#include <cctype>
#include <charconv>
#include <chrono>
#include <optional>
#include <string_view>
#include <vector>

#include "compiler/backends/backend.hpp"
#include "compiler/diagnostics/spelling.hpp"
#include "runtime/cpp/src/replay/words.hpp"

namespace robdef {
namespace {

std::string upper_case(std::string_view text) {
  std::string upper(text);
  for (char& letter : upper) {
    letter = static_cast<char>(std::toupper(static_cast<unsigned char>(letter)));
  }
  return upper;
}

template <class Number>
std::optional<Number> number_in(std::string_view text) {
  Number number = 0;
  const char* const end = text.data() + text.size();
  const auto result = std::from_chars(text.data(), end, number);
  if (text.empty() || result.ec != std::errc() || result.ptr != end) return std::nullopt;
  return number;
}

}  // namespace

std::string take_language(Options& options, const std::string& value) {
  if (find_backend(value) != nullptr) {
    options.languages = {value};
    return "";
  }
  std::string known;
  std::vector<std::string_view> names;
  for (const Backend* backend : backends()) {
    known += (known.empty() ? "`" : ", `") + std::string(backend->name()) + "`";
    names.push_back(backend->name());
  }
  const std::string_view near = nearest(value, names);
  return "unknown language `" + value + "`; " +
         (near.empty() ? "known: " + known : "did you mean `" + std::string(near) + "`?");
}

std::string take_languages(Options& options, const std::string& value) {
  for (std::size_t begin = 0; begin <= value.size();) {
    const std::size_t end = std::min(value.find(',', begin), value.size());
    Options one;
    std::string complaint = take_language(one, value.substr(begin, end - begin));
    if (!complaint.empty()) return complaint;
    const std::string& name = one.languages.front();
    if (std::ranges::find(options.languages, name) == options.languages.end()) {
      options.languages.push_back(name);
    }
    begin = end + 1;
  }
  return "";
}

std::string take_format(Options& options, const std::string& value) {
  if (value == "text") {
    options.format = Format::text;
  } else if (value == "line") {
    options.format = Format::line;
  } else if (value == "json") {
    options.format = Format::json;
  } else {
    return "unknown format `" + value + "`; known: `text`, `line`, `json`";
  }
  return "";
}

std::string take_docs_form(Options& options, const std::string& value) {
  if (value == "html") {
    options.docs_form = docs::Form::html;
  } else if (value == "markdown") {
    options.docs_form = docs::Form::markdown;
  } else {
    return "unknown format `" + value + "`; known: `html`, `markdown`";
  }
  return "";
}

std::string take_breaking_form(Options& options, const std::string& value) {
  using Form = BreakingOptions::Form;
  if (value == "text") {
    options.breaking.form = Form::text;
  } else if (value == "json") {
    options.breaking.form = Form::json;
  } else if (value == "github") {
    options.breaking.form = Form::github;
  } else {
    return "unknown format `" + value + "`; known: `text`, `json`, `github`";
  }
  return "";
}

std::string take_categories(Options& options, const std::string& value) {
  for (std::size_t begin = 0; begin <= value.size();) {
    const std::size_t end = std::min(value.find(',', begin), value.size());
    const std::string name = value.substr(begin, end - begin);
    const auto category = breaking::category_of(name);
    if (!category) {
      return "unknown category `" + name + "`; known: `wire`, `source`, `behaviour`";
    }
    options.breaking.wanted.categories.insert(*category);
    begin = end + 1;
  }
  return "";
}

std::string take_allowed(Options& options, const std::string& value) {
  const CodeEntry* const entry = find_code(upper_case(value));
  if (entry == nullptr || breaking::find_rule(entry->code) == nullptr) {
    return "`" + value + "` is no code of a breaking change; see docs/reference/breaking.md";
  }
  options.breaking.wanted.allowed.insert(entry->code);
  return "";
}

std::string take_import_folder(Options& options, const std::string& value) {
  options.search_path.folders.push_back(value);
  return value.empty() ? "the value is empty" : "";
}

std::string take_rename(Options& options, const std::string& value) {
  const std::size_t sign = value.find('=');
  if (sign == std::string::npos) return "`" + value + "` is not PATH=NAME";
  options.renames.push_back({value.substr(0, sign), value.substr(sign + 1)});
  return "";
}

std::string take_plugin_option(Options& options, const std::string& value) {
  const std::size_t sign = value.find('=');
  if (sign == std::string::npos || sign == 0) return "`" + value + "` is not KEY=VALUE";
  options.plugin_options[value.substr(0, sign)] = value.substr(sign + 1);
  return "";
}

std::string take_entry_types(Options& options, const std::string& value) {
  std::size_t begin = 0;
  while (begin <= value.size()) {
    const std::size_t end = std::min(value.find(',', begin), value.size());
    const std::string name = value.substr(begin, end - begin);
    const auto type = rr::replay::entry_type_of(name);
    if (!type) return "`" + name + "` is no type of an entry";
    options.recording.entry_types.insert(static_cast<std::uint16_t>(*type));
    begin = end + 1;
  }
  return "";
}

std::string take_connection(Options& options, const std::string& value) {
  options.recording.connection = number_in<std::uint32_t>(value);
  return options.recording.connection ? "" : "`" + value + "` is no number of a connection";
}

std::string take_port(Options& options, const std::string& value) {
  options.recording.port = number_in<std::uint16_t>(value);
  return options.recording.port ? "" : "`" + value + "` is no port";
}

std::string take_discover_format(Options& options, const std::string& value) {
  std::string complaint = take_format(options, value);
  if (!complaint.empty() || options.format != Format::line) return complaint;
  return "known here: `text`, `json`";
}

std::string take_discovery_port(Options& options, const std::string& value) {
  const auto port = number_in<std::uint16_t>(value);
  options.discover.port = port.value_or(0);
  return options.discover.port != 0 ? "" : "`" + value + "` is no port";
}

std::string take_wait(Options& options, const std::string& value) {
  const auto seconds = number_in<std::uint16_t>(value);
  options.discover.wait = std::chrono::seconds(seconds.value_or(0));
  return seconds ? "" : "`" + value + "` is no number of seconds";
}

std::string take_interface(Options& options, const std::string& value) {
  options.discover.interfaces.push_back(value);
  return value.empty() ? "the value is empty" : "";
}

std::string take_number_of_days(std::optional<int>& days, const std::string& value) {
  days = number_in<int>(value);
  const bool is_right = days && *days > 0 && *days <= 36500;
  return is_right ? "" : "`" + value + "` is no number of days from 1 to 36500";
}

}  // namespace robdef
