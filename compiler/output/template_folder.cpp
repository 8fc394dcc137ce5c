// SPDX-License-Identifier: Apache-2.0
#include "compiler/output/template_folder.hpp"

#include <fstream>
#include <iterator>
#include <sstream>
#include <system_error>
#include <utility>

namespace robdef {
namespace {

namespace fs = std::filesystem;

std::vector<OutputRule> read_rules(const std::string& text) {
  std::vector<OutputRule> rules;
  std::istringstream lines(text);
  std::string line;
  for (std::size_t number = 1; std::getline(lines, line); ++number) {
    std::istringstream words(line);
    OutputRule rule{.line = number};
    std::string more;
    if (!(words >> rule.subject) || rule.subject.starts_with('#')) continue;
    if (!(words >> rule.name >> rule.path) || words >> more) {
      throw TemplateError(TemplateFolder::rules_name, number,
                          "expected three words: subject, template, path of the output");
    }
    rules.push_back(std::move(rule));
  }
  return rules;
}

}  // namespace

TemplateFolder TemplateFolder::from_sources(TemplateSources files) {
  TemplateFolder folder;
  if (const auto rules = files.find(rules_name); rules != files.end()) {
    folder.rules = read_rules(rules->second);
    folder.has_rules = true;
    files.erase(rules);
  }
  folder.sources = std::move(files);
  return folder;
}

TemplateFolder TemplateFolder::from_disk(const std::filesystem::path& folder) {
  TemplateSources files;
  std::error_code error;
  for (const fs::directory_entry& entry : fs::directory_iterator(folder, error)) {
    const fs::path& path = entry.path();
    if (path.extension() != ".mustache" && path.filename() != rules_name) continue;
    std::ifstream in(path, std::ios::binary);
    std::string text{std::istreambuf_iterator<char>(in), {}};
    if (!in) throw TemplateError(path.string(), 1, "cannot be read");
    files.emplace(path.filename().string(), std::move(text));
  }
  if (error) throw TemplateError(folder.string(), 1, error.message());
  if (files.empty()) throw TemplateError(folder.string(), 1, "holds no template");
  return from_sources(std::move(files));
}

TemplateFolder TemplateFolder::overlaid_with(const TemplateFolder& other) const {
  TemplateFolder result = other;
  result.sources.insert(sources.begin(), sources.end());
  if (!other.has_rules) {
    result.rules = rules;
    result.has_rules = has_rules;
  }
  return result;
}

}  // namespace robdef
