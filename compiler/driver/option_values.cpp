// SPDX-License-Identifier: Apache-2.0
#include "compiler/driver/option_values.hpp"

#include <algorithm>
#include <optional>
#include <string_view>
#include <vector>

#include "compiler/backends/backend.hpp"
#include "compiler/diagnostics/spelling.hpp"

namespace robdef {

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

}  // namespace robdef
