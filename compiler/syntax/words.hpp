// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <string>
#include <string_view>
#include <vector>

namespace robdef::syntax {

/// The words that begin a statement.
enum class Keyword {
  none,
  service,
  stdver,
  option,
  import,
  using_,
  exception,
  constant,
  enum_,
  struct_,
  pod,
  namedarray,
  object,
  end,
  implements,
  field,
  property,
  function,
  event,
  objref,
  pipe,
  callback,
  wire,
  memory,
};

/// Keyword::none for any other word. Upper and lower case differ.
Keyword keyword_of(std::string_view word);
std::string_view text_of(Keyword keyword);
/// All of them, in the order of the enumeration.
const std::vector<std::string_view>& keyword_texts();

constexpr bool is_letter(char c) { return (c >= 'a' && c <= 'z') || (c >= 'A' && c <= 'Z'); }
constexpr bool is_digit(char c) { return c >= '0' && c <= '9'; }
constexpr bool is_word_character(char c) { return is_letter(c) || is_digit(c) || c == '_'; }
constexpr bool is_blank(char c) { return c == ' ' || c == '\t'; }

/// The forty words that cannot be names (06, section 7).
bool is_reserved_word(std::string_view word);
/// Whether a name begins, in any case, with `get_`, `set_`, `async_`, `rr` or `robotraconteur`.
bool has_reserved_prefix(std::string_view word);

/// struct, pod, namedarray, object, enum.
bool is_block_keyword(Keyword keyword);
/// property to memory: the members of objects.
bool is_member_keyword(Keyword keyword);
/// The modifiers of the language, `readonly` first.
const std::vector<std::string_view>& modifier_words();
/// The modifier that a word was probably meant to be; empty when none is close.
std::string_view nearest_modifier(std::string_view word);

/// `a struct`, `an object`
std::string with_article(Keyword keyword);

/// `a` or `an`, as the word wants it.
std::string_view article_for(std::string_view word);

/// Types of numbers, bool and complex included.
bool is_number_type(std::string_view word);
/// Types that have a name of the language: numbers, string, void, varvalue, varobject.
bool is_built_in_type(std::string_view word);

}  // namespace robdef::syntax
