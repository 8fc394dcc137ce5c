// SPDX-License-Identifier: Apache-2.0
#include "compiler/lsp/text.hpp"

#include <algorithm>
#include <cstring>
#include <utility>

namespace robdef::lsp {
namespace {

bool is_continuation(char c) { return (static_cast<unsigned char>(c) & 0xC0U) == 0x80U; }

// Bytes of the character at the begin of a text; 1 for what is not UTF-8.
std::size_t character_size(std::string_view text) {
  const auto first = static_cast<unsigned char>(text.front());
  const std::size_t size = first < 0x80   ? 1
                           : first < 0xC2 ? 1
                           : first < 0xE0 ? 2
                           : first < 0xF0 ? 3
                           : first < 0xF5 ? 4
                                          : 1;
  if (size > text.size()) return 1;
  const std::string_view rest = text.substr(1, size - 1);
  return std::all_of(rest.begin(), rest.end(), is_continuation) ? size : 1;
}

std::uint32_t units_of(std::size_t size, Encoding encoding) {
  if (encoding == Encoding::utf8) return static_cast<std::uint32_t>(size);
  return size == 4 ? 2 : 1;
}

std::vector<std::uint32_t> starts_of(std::string_view text) {
  std::vector<std::uint32_t> starts;
  starts.push_back(text.starts_with(byte_order_mark) ? byte_order_mark.size() : 0);
  const bool has_returns = text.find('\r') != text.npos;
  for (std::size_t at = starts.front(); at < text.size(); ++at) {
    at = has_returns ? text.find_first_of("\r\n", at) : text.find('\n', at);
    if (at == text.npos) break;
    if (text[at] == '\r' && at + 1 < text.size() && text[at + 1] == '\n') ++at;
    starts.push_back(static_cast<std::uint32_t>(at + 1));
  }
  return starts;
}

}  // namespace

Text::Text(std::string text) : text_(std::move(text)), line_starts_(starts_of(text_)) {}

std::uint32_t Text::line_end(std::uint32_t number) const {
  const std::uint32_t begin = line_starts_[number];
  std::uint32_t end = number + 1 < line_count() ? line_starts_[number + 1]
                                                : static_cast<std::uint32_t>(text_.size());
  if (end > begin && text_[end - 1] == '\n') --end;
  if (end > begin && text_[end - 1] == '\r') --end;
  return end;
}

std::string_view Text::line(std::uint32_t number) const {
  if (number >= line_count()) return {};
  const std::uint32_t begin = line_starts_[number];
  return std::string_view(text_).substr(begin, line_end(number) - begin);
}

template <class IsBefore>
Text::Count Text::count_before(std::uint32_t number, Encoding encoding, IsBefore is_before) const {
  constexpr std::uint32_t distance = 1024;
  const std::uint32_t begin = line_starts_[number];
  const std::uint32_t end = line_end(number);
  if (end - begin <= distance) return {begin, 0};
  const auto [found, is_new] = counts_.try_emplace({number, encoding});
  std::vector<Count>& counts = found->second;
  if (is_new) {
    Count at{begin, 0};
    while (at.offset < end) {
      if (counts.empty() || at.offset - counts.back().offset >= distance) counts.push_back(at);
      const std::size_t size =
          character_size(std::string_view(text_).substr(at.offset, end - at.offset));
      at.offset += static_cast<std::uint32_t>(size);
      at.units += units_of(size, encoding);
    }
  }
  const auto behind = std::partition_point(counts.begin(), counts.end(), is_before);
  return *std::prev(behind);
}

std::uint32_t Text::offset(Place place, Encoding encoding) const {
  if (place.line >= line_count()) return static_cast<std::uint32_t>(text_.size());
  const Count from = count_before(
      place.line, encoding, [&place](const Count& one) { return one.units <= place.character; });
  std::uint32_t at = from.offset;
  std::string_view rest = std::string_view(text_).substr(at, line_end(place.line) - at);
  std::uint32_t left = place.character - from.units;
  while (!rest.empty()) {
    const std::size_t size = character_size(rest);
    const std::uint32_t units = units_of(size, encoding);
    if (left < units) break;
    left -= units;
    at += static_cast<std::uint32_t>(size);
    rest.remove_prefix(size);
  }
  return at;
}

Place Text::place(std::uint32_t offset, Encoding encoding) const {
  const auto behind = std::upper_bound(line_starts_.begin(), line_starts_.end(), offset);
  if (behind == line_starts_.begin()) return {0, 0};
  const auto number = static_cast<std::uint32_t>(behind - line_starts_.begin() - 1);
  const std::uint32_t end = std::min(offset, line_end(number));
  // Characters of UTF-8 are counted in what they are made of.
  if (encoding == Encoding::utf8) return {number, end - line_starts_[number]};
  const Count from =
      count_before(number, encoding, [end](const Count& one) { return one.offset <= end; });
  std::string_view rest = std::string_view(text_).substr(from.offset, end - from.offset);
  std::uint32_t units = from.units;
  while (!rest.empty()) {
    const std::size_t size = character_size(rest);
    units += units_of(size, encoding);
    rest.remove_prefix(size);
  }
  return {number, units};
}

void Text::replace(const Range& range, std::string_view replacement, Encoding encoding) {
  if (range.end < range.start) {
    throw RequestError(ErrorCode::invalid_params, "the range ends before it starts");
  }
  const std::uint32_t begin = offset(range.start, encoding);
  const std::uint32_t end = offset(range.end, encoding);
  text_.replace(begin, end - begin, replacement);
  counts_.clear();
  line_starts_ = starts_of(text_);
}

}  // namespace robdef::lsp
