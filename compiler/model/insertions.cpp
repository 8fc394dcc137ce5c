// SPDX-License-Identifier: Apache-2.0
#include "compiler/model/insertions.hpp"

#include <algorithm>
#include <cstddef>
#include <cstdint>
#include <string_view>

#include "compiler/syntax/words.hpp"

namespace robdef::model {
namespace {

std::string_view line_end_of(std::string_view text) {
  const std::size_t first = text.find('\n');
  const bool has_return = first != text.npos && first > 0 && text[first - 1] == '\r';
  return has_return ? "\r\n" : "\n";
}

// Behind the line end; the size of the text if the last line has none.
std::size_t next_line(std::string_view text, std::size_t offset) {
  const std::size_t end = text.find('\n', std::min(offset, text.size()));
  return end == text.npos ? text.size() : end + 1;
}

std::string_view line_at(std::string_view text, std::size_t begin) {
  return text.substr(begin, next_line(text, begin) - begin);
}

std::string_view indentation_of(std::string_view line) {
  const auto end = std::find_if_not(line.begin(), line.end(), syntax::is_blank);
  return line.substr(0, static_cast<std::size_t>(end - line.begin()));
}

Replacement inserted(const Definition& user, std::size_t offset, const std::string& line) {
  const std::string_view text = user.text;
  const std::string end(line_end_of(text));
  const bool is_cut = offset > 0 && text[offset - 1] != '\n';
  const auto place = static_cast<std::uint32_t>(offset);
  return {{user.source, place, place}, is_cut ? end + line : line + end};
}

}  // namespace

Replacement import_line(const Definition& user, const std::string& service) {
  const std::string_view text = user.text;
  std::size_t place = next_line(text, std::max(user.span.end, user.version_span.end));
  for (std::size_t at = place; at < text.size(); at = next_line(text, at)) {
    std::string_view line = line_at(text, at);
    line.remove_prefix(indentation_of(line).size());
    const bool is_import = line.starts_with("import ") || line.starts_with("import\t");
    if (is_import) {
      place = at + line_at(text, at).size();
    } else if (!line.empty() && line.front() != '#' && line.front() != '\n' &&
               line.front() != '\r') {
      break;
    }
  }
  return inserted(user, place, "import " + service);
}

Replacement line_below(const Definition& user, Span at, const std::string& line) {
  const std::string_view text = user.text;
  const std::size_t before = at.begin == 0 ? text.npos : text.rfind('\n', at.begin - 1);
  const std::size_t begin = before == text.npos ? 0 : before + 1;
  const std::string indentation(indentation_of(line_at(text, begin)));
  return inserted(user, next_line(text, at.begin), indentation + line);
}

}  // namespace robdef::model
