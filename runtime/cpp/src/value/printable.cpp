// SPDX-License-Identifier: Apache-2.0
#include "rr/printable.hpp"

#include <algorithm>
#include <array>
#include <charconv>
#include <cstdint>

namespace rr {
namespace {

struct CodePoint {
  std::uint32_t value = 0;
  std::size_t size = 0;  // 0: the bytes are no UTF-8
};

std::uint32_t byte_at(std::string_view text, std::size_t at) {
  return static_cast<unsigned char>(text[at]);
}

// The first code point of a text that is not empty. Overlong forms, surrogates and what is beyond
// Unicode are no UTF-8.
CodePoint first_of(std::string_view text) {
  const std::uint32_t lead = byte_at(text, 0);
  if (lead < 0x80) return {lead, 1};
  const std::size_t size = lead >= 0xf0 ? 4 : lead >= 0xe0 ? 3 : 2;
  if (lead < 0xc2 || lead > 0xf4 || text.size() < size) return {};
  std::uint32_t value = lead & (0x7fU >> size);
  for (std::size_t i = 1; i < size; ++i) {
    const std::uint32_t next = byte_at(text, i);
    if ((next & 0xc0U) != 0x80) return {};
    value = (value << 6U) | (next & 0x3fU);
  }
  constexpr std::array<std::uint32_t, 5> least = {0, 0, 0x80, 0x800, 0x10000};
  const bool is_surrogate = value >= 0xd800 && value <= 0xdfff;
  if (value < least[size] || value > 0x10ffff || is_surrogate) return {};
  return {value, size};
}

struct Range {
  std::uint32_t first;
  std::uint32_t last;
};

// What does not show as itself: controls, marks of direction, formats, separators of lines,
// fillers, tags, noncharacters. Sorted.
constexpr Range hidden[] = {
    {0x00, 0x1f},       {0x7f, 0x9f},     {0xad, 0xad},     {0x34f, 0x34f},     {0x61c, 0x61c},
    {0x115f, 0x1160},   {0x17b4, 0x17b5}, {0x180b, 0x180f}, {0x200b, 0x200f},   {0x2028, 0x202e},
    {0x2060, 0x206f},   {0x3164, 0x3164}, {0xfdd0, 0xfdef}, {0xfe00, 0xfe0f},   {0xfeff, 0xfeff},
    {0xffa0, 0xffa0},   {0xfff0, 0xfffb}, {0xfffe, 0xffff}, {0x1bca0, 0x1bca3}, {0x1d173, 0x1d17a},
    {0xe0000, 0xe0fff},
};

bool is_hidden(std::uint32_t value) {
  const auto* const range =
      std::lower_bound(std::begin(hidden), std::end(hidden), value,
                       [](const Range& one, std::uint32_t point) { return one.last < point; });
  return range != std::end(hidden) && range->first <= value;
}

// Whether the text begins with a line break or tab that is kept. A carriage return alone would
// let what follows stand above what was before.
bool is_break(std::string_view text) {
  return text[0] == '\n' || text[0] == '\t' || text.starts_with("\r\n");
}

std::string hex(std::uint32_t value, std::size_t digits) {
  std::array<char, 8> text{};
  const auto end = std::to_chars(text.data(), text.data() + text.size(), value, 16);
  std::string result(text.data(), end.ptr);
  return std::string(result.size() < digits ? digits - result.size() : 0, '0') + result;
}

std::string escaped(std::uint32_t value) {
  if (value == '\n') return "\\n";
  if (value == '\r') return "\\r";
  if (value == '\t') return "\\t";
  return value < 0x80 ? "\\x" + hex(value, 2) : "\\u{" + hex(value, 4) + "}";
}

bool is_plain(std::string_view text) {
  return std::all_of(text.begin(), text.end(), [](char c) { return c >= ' ' && c <= '~'; });
}

}  // namespace

std::string printable(std::string_view text, std::size_t limit, LineBreaks breaks) {
  constexpr std::string_view cut = "...";
  if (text.size() <= limit && is_plain(text)) return std::string(text);
  std::string result;
  std::size_t fitting = 0;  // what stays when the rest is cut
  while (!text.empty()) {
    const CodePoint point = first_of(text);
    const std::size_t size = std::max<std::size_t>(point.size, 1);
    if (breaks == LineBreaks::kept && is_break(text)) {
      result += text[0];
    } else if (point.size == 0) {
      result += "\\x" + hex(byte_at(text, 0), 2);
    } else if (is_hidden(point.value)) {
      result += escaped(point.value);
    } else {
      result += text.substr(0, size);
    }
    if (result.size() > limit) return result.substr(0, fitting).append(cut);
    if (limit - result.size() >= cut.size()) fitting = result.size();
    text.remove_prefix(size);
  }
  return result;
}

std::string printable_json(std::string_view json) {
  if (is_plain(json)) return std::string(json);
  std::string result;
  const auto escape = [&](std::uint32_t unit) { result += "\\u" + hex(unit, 4); };
  while (!json.empty()) {
    const CodePoint point = first_of(json);
    const std::size_t size = std::max<std::size_t>(point.size, 1);
    if (point.size == 0) {
      result += "\xef\xbf\xbd";
    } else if (point.value < 0x7f || !is_hidden(point.value)) {
      result += json.substr(0, size);  // JSON has escaped the lower ones itself
    } else if (point.value < 0x10000) {
      escape(point.value);
    } else {
      escape(0xd800 + ((point.value - 0x10000) >> 10U));
      escape(0xdc00 + ((point.value - 0x10000) & 0x3ffU));
    }
    json.remove_prefix(size);
  }
  return result;
}

}  // namespace rr
