// SPDX-License-Identifier: Apache-2.0
#include "runtime/cpp/src/endpoint/service_path.hpp"

#include <algorithm>
#include <utility>

namespace rr::endpoint {
namespace {

constexpr bool is_letter(char c) { return (c >= 'a' && c <= 'z') || (c >= 'A' && c <= 'Z'); }
constexpr bool is_digit(char c) { return c >= '0' && c <= '9'; }

int hexadecimal(char c) {
  if (is_digit(c)) return c - '0';
  if (c >= 'a' && c <= 'f') return c - 'a' + 10;
  if (c >= 'A' && c <= 'F') return c - 'A' + 10;
  return -1;
}

// A letter, then letters, digits and underscores, no underscore at the end.
bool is_name(std::string_view text) {
  if (text.empty() || !is_letter(text.front()) || text.back() == '_') return false;
  return std::all_of(text.begin(), text.end(),
                     [](char c) { return is_letter(c) || is_digit(c) || c == '_'; });
}

// Both cases of digits and a bare underscore are taken, though we write neither.
std::optional<std::string> decode_index(std::string_view text) {
  if (text.empty()) return std::nullopt;
  std::string decoded;
  for (std::size_t i = 0; i < text.size(); ++i) {
    if (is_letter(text[i]) || is_digit(text[i]) || text[i] == '_') {
      decoded.push_back(text[i]);
      continue;
    }
    if (text[i] != '%' || i + 2 >= text.size()) return std::nullopt;
    const int high = hexadecimal(text[i + 1]);
    const int low = hexadecimal(text[i + 2]);
    if (high < 0 || low < 0) return std::nullopt;
    decoded.push_back(static_cast<char>(high * 16 + low));
    i += 2;
  }
  return decoded;
}

std::optional<PathSegment> parse_segment(std::string_view text) {
  PathSegment segment;
  const std::size_t bracket = text.find('[');
  if (bracket != std::string_view::npos) {
    if (!text.ends_with(']')) return std::nullopt;
    segment.index = decode_index(text.substr(bracket + 1, text.size() - bracket - 2));
    if (!segment.index) return std::nullopt;
    text = text.substr(0, bracket);
  }
  if (!is_name(text)) return std::nullopt;
  segment.name = text;
  return segment;
}

}  // namespace

std::optional<std::vector<PathSegment>> parse_path(std::string_view path) {
  std::vector<PathSegment> segments;
  while (true) {
    const std::size_t dot = path.find('.');
    auto segment = parse_segment(path.substr(0, dot));
    if (!segment || (segments.empty() && segment->index)) return std::nullopt;
    segments.push_back(std::move(*segment));
    if (dot == std::string_view::npos) return segments;
    path.remove_prefix(dot + 1);
  }
}

std::string escape_index(std::string_view index) {
  constexpr std::string_view digits = "0123456789abcdef";
  std::string escaped;
  for (const char c : index) {
    if (is_letter(c) || is_digit(c)) {
      escaped.push_back(c);
      continue;
    }
    const auto byte = static_cast<unsigned char>(c);
    escaped.push_back('%');
    escaped.push_back(digits[byte / 16]);
    escaped.push_back(digits[byte % 16]);
  }
  return escaped;
}

std::string canonical_path(const std::vector<PathSegment>& segments) {
  std::string path;
  for (const PathSegment& segment : segments) {
    if (!path.empty()) path.push_back('.');
    path += segment.name;
    if (segment.index) path += "[" + escape_index(*segment.index) + "]";
  }
  return path;
}

bool is_at_or_below(std::string_view path, std::string_view ancestor) {
  return path.starts_with(ancestor) &&
         (path.size() == ancestor.size() || path[ancestor.size()] == '.');
}

}  // namespace rr::endpoint
