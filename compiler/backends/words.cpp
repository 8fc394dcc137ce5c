// SPDX-License-Identifier: Apache-2.0
#include "compiler/backends/words.hpp"

#include <algorithm>
#include <cstddef>

namespace robdef {
namespace {

// Names are ASCII; the locale has no say.
bool is_upper(char c) { return c >= 'A' && c <= 'Z'; }
bool is_lower(char c) { return c >= 'a' && c <= 'z'; }
char to_upper(char c) { return is_lower(c) ? static_cast<char>(c - 'a' + 'A') : c; }
char to_lower(char c) { return is_upper(c) ? static_cast<char>(c - 'A' + 'a') : c; }

std::string lower(std::string_view text) {
  std::string result(text);
  for (char& c : result) c = to_lower(c);
  return result;
}

/// An upper case letter begins a word after a lower case letter or digit, and before a lower case
/// letter: the `L` of `RGBLight`.
bool begins_word(std::string_view name, std::size_t at) {
  if (at == 0 || !is_upper(name[at])) return false;
  if (!is_upper(name[at - 1])) return true;
  return at + 1 < name.size() && is_lower(name[at + 1]);
}

}  // namespace

std::vector<std::string> words_of(std::string_view name) {
  std::vector<std::string> words;
  std::string word;
  const auto finish = [&] {
    if (!word.empty()) words.push_back(word);
    word.clear();
  };
  for (std::size_t at = 0; at < name.size(); ++at) {
    if (name[at] == '_' || begins_word(name, at)) finish();
    if (name[at] != '_') word += name[at];
  }
  finish();
  return words;
}

std::string pascal_case(std::string_view name) {
  std::string result;
  for (const std::string& word : words_of(name)) {
    result += to_upper(word.front());
    result += word.substr(1);
  }
  return result;
}

std::string camel_case(std::string_view name) {
  std::string result;
  for (const std::string& word : words_of(name)) {
    result += result.empty() ? lower(word) : to_upper(word.front()) + word.substr(1);
  }
  return result;
}

std::string snake_case(std::string_view name) {
  std::vector<std::string> words = words_of(name);
  for (std::string& word : words) word = lower(word);
  return join(words, "_");
}

std::string as_variable(std::string name) {
  if (name.empty() || (name.front() >= '0' && name.front() <= '9')) name.insert(0, "p_");
  return name;
}

std::string without_capitals(std::string_view name) {
  return std::ranges::any_of(name, is_lower) ? std::string(name) : lower(name);
}

std::vector<std::string> segments_of(std::string_view name) {
  std::vector<std::string> segments;
  while (true) {
    const std::size_t dot = name.find('.');
    segments.emplace_back(name.substr(0, dot));
    if (dot == std::string_view::npos) return segments;
    name.remove_prefix(dot + 1);
  }
}

std::vector<std::string_view> lines_of(std::string_view text) {
  std::vector<std::string_view> lines;
  while (!text.empty()) {
    const std::size_t end = text.find('\n');
    const std::size_t size = end == std::string_view::npos ? text.size() : end + 1;
    lines.push_back(text.substr(0, size));
    text.remove_prefix(size);
  }
  return lines;
}

std::string replace_all(std::string_view text, std::string_view from, std::string_view to) {
  std::string result;
  while (true) {
    const std::size_t at = text.find(from);
    result += text.substr(0, at);
    if (at == std::string_view::npos) return result;
    result += to;
    text.remove_prefix(at + from.size());
  }
}

std::string join(const std::vector<std::string>& pieces, std::string_view separator) {
  std::string result;
  for (const std::string& piece : pieces) {
    if (&piece != &pieces.front()) result += separator;
    result += piece;
  }
  return result;
}

}  // namespace robdef
