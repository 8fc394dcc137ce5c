// SPDX-License-Identifier: Apache-2.0
#include "compiler/diagnostics/source.hpp"

#include <algorithm>
#include <cstring>
#include <utility>

namespace robdef {

Source::Source(std::string name, std::string text)
    : name_(std::move(name)), text_(std::move(text)), line_starts_{0} {
  const char* const begin = text_.data();
  const char* const end = begin + text_.size();
  for (const char* at = begin; at != end;) {
    const void* const found = std::memchr(at, '\n', static_cast<std::size_t>(end - at));
    if (found == nullptr) break;
    at = static_cast<const char*>(found) + 1;
    line_starts_.push_back(static_cast<std::uint32_t>(at - begin));
  }
}

Position Source::position(std::uint32_t offset) const {
  const auto after = std::upper_bound(line_starts_.begin(), line_starts_.end(), offset);
  const auto line = static_cast<std::uint32_t>(after - line_starts_.begin());
  std::uint32_t column = offset - line_starts_[line - 1] + 1;
  // The byte order mark is not part of what people see on the first line.
  if (line == 1 && text_.starts_with(byte_order_mark)) {
    column = column > byte_order_mark.size()
                 ? column - static_cast<std::uint32_t>(byte_order_mark.size())
                 : 1;
  }
  return {line, column};
}

std::optional<std::uint32_t> Source::offset(Position position) const {
  if (position.line == 0 || position.line > line_starts_.size()) return std::nullopt;
  const std::string_view text = line(position.line);
  if (position.column == 0 || position.column - 1 > text.size()) return std::nullopt;
  return static_cast<std::uint32_t>(text.data() - text_.data()) + position.column - 1;
}

std::string_view Source::line(std::uint32_t number) const {
  if (number == 0 || number > line_starts_.size()) return {};
  std::string_view text = std::string_view(text_).substr(line_starts_[number - 1]);
  text = text.substr(0, text.find('\n'));
  while (text.ends_with('\r')) text.remove_suffix(1);
  if (number == 1 && text.starts_with(byte_order_mark)) text.remove_prefix(byte_order_mark.size());
  return text;
}

std::uint32_t Source::line_count() const { return static_cast<std::uint32_t>(line_starts_.size()); }

SourceId Sources::add(std::string name, std::string text) {
  sources_.emplace_back(std::move(name), std::move(text));
  return SourceId{static_cast<std::uint32_t>(sources_.size() - 1)};
}

const Source& Sources::operator[](SourceId id) const {
  return sources_[static_cast<std::uint32_t>(id)];
}

std::size_t Sources::size() const { return sources_.size(); }

}  // namespace robdef
