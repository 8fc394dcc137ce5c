// SPDX-License-Identifier: Apache-2.0
#include "compiler/output/cpp_brackets.hpp"

#include <algorithm>
#include <array>

namespace robdef::cpp {
namespace {

enum class Kind : unsigned char { plain, opens, closes, quote };

constexpr std::array<Kind, 256> kinds = [] {
  std::array<Kind, 256> all{};
  for (const char c : std::string_view("(<{[")) all[static_cast<unsigned char>(c)] = Kind::opens;
  for (const char c : std::string_view(")>}]")) all[static_cast<unsigned char>(c)] = Kind::closes;
  all[static_cast<unsigned char>('"')] = Kind::quote;
  return all;
}();

/// Finds places of a text that are in no brackets and no string.
class Reader {
 public:
  explicit Reader(std::string_view text) : text_(text) {}

  /// Whether there is another one; `at` is its place then.
  bool next() {
    while (++at < text_.size()) {
      const char c = text_[at];
      if (is_in_string_) {
        if (c == '\\') ++at;
        is_in_string_ = c != '"';
        continue;
      }
      const Kind kind = kinds[static_cast<unsigned char>(c)];
      if (kind == Kind::plain) {
        if (depth_ == 0) return true;
        continue;
      }
      if (kind == Kind::quote) {
        is_in_string_ = true;
        continue;
      }
      if (kind == Kind::opens) {
        if (depth_++ == 0) return true;
        continue;
      }
      const bool is_arrow = c == '>' && at > 0 && text_[at - 1] == '-';
      if (!is_arrow && depth_ > 0) {
        if (--depth_ == 0) return true;
        continue;
      }
      if (depth_ == 0) return true;
    }
    return false;
  }

  std::size_t at = nowhere;

 private:
  std::string_view text_;
  std::size_t depth_ = 0;
  bool is_in_string_ = false;
};

}  // namespace

std::size_t find_outside(std::string_view text, char wanted) {
  Reader reader(text);
  while (reader.next()) {
    if (text[reader.at] == wanted) return reader.at;
  }
  return nowhere;
}

std::size_t find_last_outside(std::string_view text, char wanted) {
  std::size_t found = nowhere;
  Reader reader(text);
  while (reader.next()) {
    if (text[reader.at] == wanted) found = reader.at;
  }
  return found;
}

std::size_t find_word(std::string_view text, std::string_view word) {
  Reader reader(text);
  while (reader.next()) {
    if (text.substr(reader.at).starts_with(word)) return reader.at;
  }
  return nowhere;
}

std::vector<std::string> items_of(std::string_view text) {
  std::vector<std::string> items;
  while (!text.empty()) {
    const std::size_t comma = find_outside(text, ',');
    items.emplace_back(text.substr(0, comma));
    if (comma == nowhere) break;
    text.remove_prefix(std::min(comma + 2, text.size()));
  }
  return items;
}

std::optional<List> list_of(std::string_view text, char bracket) {
  const std::size_t open = find_outside(text, bracket);
  if (open == nowhere) return std::nullopt;
  const std::size_t length = find_outside(text.substr(open), bracket == '(' ? ')' : '}');
  if (length == nowhere) return std::nullopt;
  const std::size_t close = open + length;
  return List{.before = std::string(text.substr(0, open + 1)),
              .items = items_of(text.substr(open + 1, close - open - 1)),
              .after = std::string(text.substr(close))};
}

}  // namespace robdef::cpp
