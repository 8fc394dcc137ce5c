// SPDX-License-Identifier: Apache-2.0
#include "compiler/diagnostics/excerpt.hpp"

#include <fmt/format.h>

#include <algorithm>
#include <string_view>
#include <tuple>

namespace robdef {
namespace {

// Longer lines are cut: generated definitions can have lines of a megabyte.
constexpr std::size_t widest = 160;
constexpr std::size_t context_before = 60;

// Bytes of the UTF-8 sequence at the start of the text; 0 if there is none. Overlong forms and
// surrogates are let through: they are shown, not interpreted.
std::size_t sequence_length(std::string_view text) {
  const auto first = static_cast<unsigned char>(text.front());
  std::size_t length = 0;
  if (first < 0x80) {
    length = 1;
  } else if (first >= 0xC2 && first < 0xE0) {
    length = 2;
  } else if (first >= 0xE0 && first < 0xF0) {
    length = 3;
  } else if (first >= 0xF0 && first < 0xF5) {
    length = 4;
  }
  if (length > text.size()) return 0;
  for (std::size_t i = 1; i < length; ++i) {
    if ((static_cast<unsigned char>(text[i]) & 0xC0) != 0x80) return 0;
  }
  return length;
}

// How many characters people see for these bytes.
std::size_t shown_width(std::string_view text) {
  std::size_t width = 0;
  while (!text.empty()) {
    text.remove_prefix(std::max<std::size_t>(1, sequence_length(text)));
    ++width;
  }
  return width;
}

// The part of a line that is shown, and where its first byte stands in the line.
struct Window {
  std::string_view text;
  std::size_t begin = 0;
  bool is_cut_before = false;
  bool is_cut_after = false;
};

Window window_around(std::string_view line, std::size_t column) {
  if (line.size() <= widest) return {line, 0, false, false};
  const std::size_t begin = column > context_before ? column - context_before : 0;
  const std::string_view text = line.substr(std::min(begin, line.size()), widest);
  return {text, begin, begin > 0, begin + text.size() < line.size()};
}

std::string marks(const Window& window, std::size_t column, std::size_t length,
                  const Marking& marking) {
  const std::size_t begin = std::min(column - window.begin, window.text.size());
  const std::size_t end = std::min(begin + length, window.text.size());
  const std::size_t before = shown_width(window.text.substr(0, begin));
  const std::size_t width =
      std::max<std::size_t>(1, shown_width(window.text.substr(begin, end - begin)));
  std::string result = fmt::format("{:{}}{}", "", before + (window.is_cut_before ? 3 : 0),
                                   std::string(width, marking.is_primary ? '^' : '-'));
  if (!marking.label->text.empty()) result += ' ' + marking.label->text;
  return result;
}

}  // namespace

std::string printable(std::string_view text) {
  std::string result;
  result.reserve(text.size());
  while (!text.empty()) {
    const std::size_t length = sequence_length(text);
    if (length == 0) {
      result += '?';
    } else if (length == 1 && (text.front() < ' ' || text.front() == '\x7F')) {
      result += ' ';
    } else {
      result += text.substr(0, length);
    }
    text.remove_prefix(std::max<std::size_t>(1, length));
  }
  return result;
}

std::string excerpt(const Source& source, std::vector<Marking> markings, std::size_t gutter) {
  std::sort(markings.begin(), markings.end(), [](const Marking& a, const Marking& b) {
    return std::tuple(a.label->span.begin, a.is_primary) <
           std::tuple(b.label->span.begin, b.is_primary);
  });
  std::string result = fmt::format("{:{}} |\n", "", gutter);
  std::uint32_t previous = 0;
  for (const Marking& marking : markings) {
    const Span span = marking.label->span;
    const Position place = source.position(span.begin);
    const Window window = window_around(source.line(place.line), place.column - 1);
    if (place.line != previous || window.is_cut_before || window.is_cut_after) {
      if (previous != 0 && place.line > previous + 1) result += "...\n";
      result +=
          fmt::format("{:>{}} | {}{}{}\n", place.line, gutter, window.is_cut_before ? "..." : "",
                      printable(window.text), window.is_cut_after ? "..." : "");
    }
    result += fmt::format("{:{}} | {}\n", "", gutter,
                          marks(window, place.column - 1, span.end - span.begin, marking));
    previous = place.line;
  }
  return result;
}

}  // namespace robdef
