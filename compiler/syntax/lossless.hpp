// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <cstddef>
#include <cstdint>
#include <span>
#include <string_view>
#include <vector>

/// A file as it was written: its lines and their tokens, comments and blank lines included. Also of
/// files with mistakes. What formats, renames or shows definitions works on these places; the rest
/// of the syntax tree says what they mean.
namespace robdef::ast {

enum class TokenKind : std::uint8_t {
  keyword,  ///< first word of a statement, `as`, `list` of a container, `struct` after `end`
  name,     ///< plain or dotted, of types as well
  number,
  version,
  string,
  text,    ///< what follows `option`
  symbol,  ///< `-` and `*` of an array
  comma,
  equals,
  colon,
  open_parameters,
  close_parameters,
  open_array,
  close_array,
  open_container,
  close_container,
  open_modifiers,
  close_modifiers,
  open_arguments,  ///< of a modifier
  close_arguments,
  open_value,  ///< braces around a constant's numbers or fields
  close_value,
};

/// `open_modifiers`, ...
std::string_view name_of(TokenKind kind);

/// Offsets into the text, without the blanks around it. A string may contain a continuation.
struct Token {
  TokenKind kind{};
  std::uint32_t begin = 0;
  std::uint32_t end = 0;
};

enum class LineKind : std::uint8_t {
  blank,
  comment,        ///< `#`
  documentation,  ///< `##`
  statement,      ///< fits the grammar; has tokens
  unread,         ///< anything else; was reported, or follows a line that was
};

/// `statement`, ...
std::string_view name_of(LineKind kind);

/// One line, its line end included, or several that are continued.
struct Line {
  LineKind kind{};
  bool is_in_block = false;  ///< between the first line of a block and its `end`
  /// Means the same wherever it stands, and nothing was reported or allowed while it was read, nor
  /// while the lines between it and the statement above were.
  bool is_plain = false;
  std::uint32_t begin = 0;
  std::uint32_t end = 0;
  std::uint32_t first_token = 0;
  std::uint32_t token_count = 0;
};

/// The lines follow each other without gaps and cover the text, all but a byte order mark. Between
/// the tokens of a statement there are blanks and continuations only.
struct LosslessText {
  std::vector<Line> lines;
  std::vector<Token> tokens;

  /// Empty for all lines but statements.
  [[nodiscard]] std::span<const Token> tokens_of(const Line& line) const {
    return std::span(tokens).subspan(line.first_token, line.token_count);
  }
  /// The line at an offset; nullptr before the first and behind the last.
  [[nodiscard]] const Line* line_at(std::uint32_t offset) const;
};

}  // namespace robdef::ast
