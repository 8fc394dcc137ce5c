// SPDX-License-Identifier: Apache-2.0
#include "runtime/cpp/src/client/definition_text.hpp"

#include <cstddef>

namespace rr::client {
namespace {

constexpr std::string_view blanks = " \t\r\f\v";

// The words of the next line that has any, a line that ends in a backslash going on in the next
// one. False at the end.
bool next_line(std::string_view& text, std::vector<std::string_view>& words) {
  words.clear();
  bool goes_on = false;
  while (!text.empty() && (words.empty() || goes_on)) {
    const std::size_t end = text.find('\n');
    std::string_view line = text.substr(0, end);
    text.remove_prefix(end == std::string_view::npos ? text.size() : end + 1);
    if (line.ends_with('\r')) line.remove_suffix(1);
    goes_on = line.ends_with('\\');
    if (goes_on) line.remove_suffix(1);
    while (true) {
      const std::size_t begin = line.find_first_not_of(blanks);
      if (begin == std::string_view::npos || line[begin] == '#') break;
      line.remove_prefix(begin);
      const std::size_t length = line.find_first_of(blanks);
      words.push_back(line.substr(0, length));
      if (length == std::string_view::npos) break;
      line.remove_prefix(length);
    }
  }
  return !words.empty();
}

std::string_view last_part(std::string_view name) {
  const std::size_t dot = name.rfind('.');
  return dot == std::string_view::npos ? name : name.substr(dot + 1);
}

}  // namespace

DefinitionOutline outline(std::string_view text) {
  DefinitionOutline result;
  std::map<std::string, std::string, std::less<>> aliases;
  const auto qualify = [&](std::string_view name) {
    if (const auto alias = aliases.find(name); alias != aliases.end()) return alias->second;
    if (name.find('.') != std::string_view::npos) return std::string(name);
    return result.name + "." + std::string(name);
  };
  std::vector<std::string_view> words;
  std::vector<std::string>* implements = nullptr;
  while (next_line(text, words)) {
    const std::string_view what = words[0];
    if (what == "object" && words.size() == 2) {
      implements = &result.objects[std::string(words[1])];
    } else if (what == "end") {
      implements = nullptr;
    } else if (words.size() < 2) {
      continue;
    } else if (implements != nullptr) {
      if (what == "implements") implements->push_back(qualify(words[1]));
    } else if (what == "service") {
      result.name = words[1];
    } else if (what == "import") {
      result.imports.emplace_back(words[1]);
    } else if (what == "using") {
      const std::string_view alias = words.size() == 4 ? words[3] : last_part(words[1]);
      aliases[std::string(alias)] = words[1];
    }
  }
  return result;
}

std::string declared_version(std::string_view text) {
  std::string version;
  std::vector<std::string_view> words;
  while (next_line(text, words)) {
    if (words[0] == "stdver" && words.size() > 1) return std::string(words[1]);
    if (words[0] == "option" && words.size() == 3 && words[1] == "version") version = words[2];
  }
  return version;
}

}  // namespace rr::client
