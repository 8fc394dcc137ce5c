// SPDX-License-Identifier: Apache-2.0
#include "compiler/backends/arduino/limits.hpp"

#include <algorithm>
#include <charconv>
#include <sstream>
#include <vector>

namespace robdef::arduino {
namespace {

constexpr std::string_view limit_word = "@limit";
constexpr std::string_view root_word = "@root";

std::vector<std::string> words_of(const std::string& line) {
  std::istringstream stream(line);
  std::vector<std::string> words;
  for (std::string word; stream >> word;) words.push_back(word);
  return words;
}

std::vector<std::string> lines_of(std::string_view text) {
  std::istringstream stream{std::string(text)};
  std::vector<std::string> lines;
  for (std::string line; std::getline(stream, line);) lines.push_back(line);
  return lines;
}

bool begins_with(const std::string& line, std::string_view word) {
  const std::vector<std::string> words = words_of(line);
  return !words.empty() && words.front() == word;
}

std::optional<std::uint32_t> number_of(const std::string& word) {
  std::uint32_t number = 0;
  const char* const end = word.data() + word.size();
  const auto [at, error] = std::from_chars(word.data(), end, number);
  if (error != std::errc() || at != end || number == 0) return std::nullopt;
  return number;
}

}  // namespace

Limits::Limits(std::string_view documentation, Span span, Report& report) : span_(span) {
  for (const std::string& line : lines_of(documentation)) {
    const std::vector<std::string> words = words_of(line);
    if (words.empty() || words.front() != limit_word) continue;
    const auto number =
        words.size() == 2 || words.size() == 3 ? number_of(words.back()) : std::nullopt;
    const std::string name = words.size() == 3 ? words[1] : "";
    if (!number || !limits_.try_emplace(name, Limit{*number}).second) {
      report.add(Code::R0923, span, "`" + line + "` is not understood")
          .help("write `@limit 16`, or `@limit name 16` for a parameter, each once");
    }
  }
}

std::optional<std::uint32_t> Limits::of(std::string_view name) const {
  const auto found = limits_.find(name);
  if (found == limits_.end()) return std::nullopt;
  found->second.is_used = true;
  return found->second.value;
}

void Limits::report_unused(Report& report) const {
  for (const auto& [name, limit] : limits_) {
    if (limit.is_used) continue;
    report
        .add(Code::R0923, span_,
             name.empty() ? "there is nothing here that `@limit` could be for"
                          : "nothing that needs a limit is called `" + name + "` here")
        .help("remove the line, or name a parameter that is a string or an array without a length");
  }
}

std::string without_limits(std::string_view documentation) {
  std::string text;
  for (const std::string& line : lines_of(documentation)) {
    if (begins_with(line, limit_word) || begins_with(line, root_word)) continue;
    text += (text.empty() ? "" : "\n") + line;
  }
  return text;
}

bool is_marked_root(std::string_view documentation) {
  return std::ranges::any_of(lines_of(documentation),
                             [](const std::string& line) { return begins_with(line, root_word); });
}

}  // namespace robdef::arduino
