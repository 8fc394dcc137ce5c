// SPDX-License-Identifier: Apache-2.0
#include "runtime/cpp/src/client/definition_text.hpp"

#include <cstddef>
#include <utility>

namespace rr::client {
namespace {

constexpr std::string_view blanks = " \t\r\f\v";

std::string_view last_part(std::string_view name) {
  const std::size_t dot = name.rfind('.');
  return dot == std::string_view::npos ? name : name.substr(dot + 1);
}

}  // namespace

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
    const bool opens_object = what == "object" && words.size() == 2;
    const bool is_listed = implements != nullptr ? what == "implements"
                                                 : opens_object || what == "service" ||
                                                       what == "import" || what == "using";
    if (what == "end") implements = nullptr;
    if (words.size() < 2 || !(is_listed || opens_object)) continue;
    if (words[1].size() > longest_name) {
      result.has_long_names = true;
      continue;
    }
    ++result.size;
    if (opens_object) {
      implements = &result.objects[std::string(words[1])];
    } else if (implements != nullptr) {
      implements->push_back(qualify(words[1]));
    } else if (what == "service") {
      result.name = words[1];
    } else if (what == "import") {
      result.imports.emplace_back(words[1]);
    } else {
      const std::string_view alias = words.size() == 4 ? words[3] : last_part(words[1]);
      aliases[std::string(alias)] = words[1];
    }
    if (result.size > longest_outline) break;
  }
  return result;
}

namespace {

// The name behind a type, which may have blanks in its brackets only, and the rest of the line.
DeclaredMember read_member(const std::vector<std::string_view>& words) {
  int open = 0;
  for (std::size_t i = 1; i + 1 < words.size(); ++i) {
    for (const char c : words[i]) {
      if (c == '[' || c == '{') ++open;
      if (c == ']' || c == '}') --open;
    }
    const char next = words[i + 1][0];
    if (open != 0 || next == '[' || next == '{') continue;
    const std::string_view name = words[i + 1].substr(0, words[i + 1].find_first_of("([{"));
    DeclaredMember member{std::string(words[0]), std::string(name), {}};
    member.modifiers = words[i + 1].substr(name.size());
    for (std::size_t rest = i + 2; rest < words.size(); ++rest) member.modifiers += words[rest];
    return member;
  }
  return {};
}

}  // namespace

std::map<std::string, std::vector<DeclaredMember>> declared_members(std::string_view text) {
  std::map<std::string, std::vector<DeclaredMember>> objects;
  std::vector<DeclaredMember>* members = nullptr;
  std::vector<std::string_view> words;
  while (next_line(text, words)) {
    if (words[0] == "object" && words.size() == 2) {
      members = &objects[std::string(words[1])];
    } else if (words[0] == "end") {
      members = nullptr;
    } else if (members != nullptr && words[0] == "event" && words.size() > 1) {
      members->push_back({"event", std::string(words[1].substr(0, words[1].find('('))), {}});
    } else if (members != nullptr) {
      DeclaredMember member = read_member(words);
      if (!member.name.empty()) members->push_back(std::move(member));
    }
  }
  return objects;
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
