// SPDX-License-Identifier: Apache-2.0
#include "compiler/output/prose.hpp"

namespace robdef {
namespace {

constexpr std::string_view blanks = " \t\r";

std::string_view without_trailing_blanks(std::string_view text) {
  return text.substr(0, text.find_last_not_of(blanks) + 1);  // npos + 1 is 0
}

/// Takes as many words as fit, at least one, and the blanks behind them.
std::string_view take_words(std::string_view& rest, std::size_t width) {
  std::size_t end = rest.size();
  if (end > width) {
    end = rest.find_last_of(blanks, width);
    if (end == std::string_view::npos || rest.find_first_not_of(blanks) >= end) {
      end = rest.find_first_of(blanks, rest.find_first_not_of(blanks));
    }
    if (end == std::string_view::npos) end = rest.size();
  }
  const std::string_view line = rest.substr(0, end);
  const std::size_t next = rest.find_first_not_of(blanks, end);
  rest = next == std::string_view::npos ? std::string_view() : rest.substr(next);
  return line;
}

}  // namespace

std::vector<std::string> prose(std::string_view text, std::string_view mark, std::size_t width) {
  std::vector<std::string> lines;
  const auto add = [&](std::string_view content) {
    lines.emplace_back(without_trailing_blanks(std::string(mark) + std::string(content)));
  };
  while (!text.empty()) {
    const std::size_t line_end = text.find('\n');
    std::string_view line = without_trailing_blanks(text.substr(0, line_end));
    text.remove_prefix(line_end == std::string_view::npos ? text.size() : line_end + 1);
    if (line.empty()) {
      add({});
      continue;
    }
    const std::string_view indent = line.substr(0, line.find_first_not_of(blanks));
    line.remove_prefix(indent.size());
    const std::size_t used = mark.size() + indent.size();
    while (!line.empty()) {
      const std::string_view words = take_words(line, width > used ? width - used : 1);
      add(std::string(indent) + std::string(words));
    }
  }
  return lines;
}

}  // namespace robdef
