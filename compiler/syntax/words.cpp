// SPDX-License-Identifier: Apache-2.0
#include "compiler/syntax/words.hpp"

#include <algorithm>
#include <array>

#include "compiler/diagnostics/spelling.hpp"

namespace robdef::syntax {
namespace {

constexpr std::array keywords = {
    std::string_view("service"),  std::string_view("stdver"),     std::string_view("option"),
    std::string_view("import"),   std::string_view("using"),      std::string_view("exception"),
    std::string_view("constant"), std::string_view("enum"),       std::string_view("struct"),
    std::string_view("pod"),      std::string_view("namedarray"), std::string_view("object"),
    std::string_view("end"),      std::string_view("implements"), std::string_view("field"),
    std::string_view("property"), std::string_view("function"),   std::string_view("event"),
    std::string_view("objref"),   std::string_view("pipe"),       std::string_view("callback"),
    std::string_view("wire"),     std::string_view("memory"),
};
static_assert(keywords.size() == static_cast<std::size_t>(Keyword::memory));

constexpr std::array<std::string_view, 13> number_types = {
    "double", "single", "int8",   "uint8",   "int16",   "uint16", "int32",
    "uint32", "int64",  "uint64", "cdouble", "csingle", "bool"};

constexpr std::array<std::string_view, 4> other_types = {"void", "string", "varvalue", "varobject"};

template <std::size_t size>
bool contains(const std::array<std::string_view, size>& words, std::string_view word) {
  return std::find(words.begin(), words.end(), word) != words.end();
}

constexpr std::size_t slots = 256;
constexpr std::size_t slot_of(std::string_view word) {
  return (std::size_t{static_cast<unsigned char>(word.front())} * 7U + word.size() * 31U) % slots;
}

// Which first letters and lengths words of a list have, because most words are none of them.
template <std::size_t size>
constexpr void mark(const std::array<std::string_view, size>& words,
                    std::array<bool, slots>& marks) {
  for (const std::string_view word : words) marks[slot_of(word)] = true;
}

constexpr std::array<bool, slots> reserved_slots = [] {
  std::array<bool, slots> marks{};
  mark(keywords, marks);
  mark(number_types, marks);
  mark(other_types, marks);
  return marks;
}();

bool begins_in_any_case(std::string_view word, std::string_view lower_prefix) {
  const auto same = [](char lower, char c) { return lower == (c >= 'A' && c <= 'Z' ? c + 32 : c); };
  return word.size() >= lower_prefix.size() &&
         std::equal(lower_prefix.begin(), lower_prefix.end(), word.begin(), same);
}

}  // namespace

Keyword keyword_of(std::string_view word) {
  const auto found = std::find(keywords.begin(), keywords.end(), word);
  if (found == keywords.end()) return Keyword::none;
  return static_cast<Keyword>(found - keywords.begin() + 1);
}

std::string_view text_of(Keyword keyword) {
  if (keyword == Keyword::none) return {};
  return keywords[static_cast<std::size_t>(keyword) - 1];
}

const std::vector<std::string_view>& keyword_texts() {
  static const std::vector<std::string_view> texts(keywords.begin(), keywords.end());
  return texts;
}

const std::vector<std::string_view>& modifier_words() {
  static const std::vector<std::string_view> words = {
      "readonly", "writeonly", "unreliable", "nolock", "nolockread", "perclient", "urgent"};
  return words;
}

std::string_view nearest_modifier(std::string_view word) {
  // Twice the longest modifier: longer words mean something else, and need no comparison.
  constexpr std::size_t longest = 20;
  return word.size() > longest ? std::string_view() : nearest(word, modifier_words());
}

bool is_reserved_word(std::string_view word) {
  if (word.empty() || !reserved_slots[slot_of(word)]) return false;
  return contains(keywords, word) || is_built_in_type(word);
}

bool has_reserved_prefix(std::string_view word) {
  constexpr std::string_view first_letters = "gsarGSAR";
  if (word.empty() || first_letters.find(word.front()) == first_letters.npos) return false;
  for (const std::string_view prefix : {"get_", "set_", "async_", "rr", "robotraconteur"}) {
    if (begins_in_any_case(word, prefix)) return true;
  }
  return false;
}

bool is_block_keyword(Keyword keyword) {
  return keyword >= Keyword::enum_ && keyword <= Keyword::object;
}

bool is_member_keyword(Keyword keyword) {
  return keyword >= Keyword::property && keyword <= Keyword::memory;
}

std::string with_article(Keyword keyword) {
  return std::string(article_for(text_of(keyword))) + " " + std::string(text_of(keyword));
}

std::string_view article_for(std::string_view word) {
  return std::string_view("aeiou").find(word.front()) == std::string_view::npos ? "a" : "an";
}

bool is_number_type(std::string_view word) { return contains(number_types, word); }

bool is_built_in_type(std::string_view word) {
  return is_number_type(word) || contains(other_types, word);
}

}  // namespace robdef::syntax
