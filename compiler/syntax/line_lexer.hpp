// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <cstddef>
#include <string_view>
#include <vector>

namespace robdef::syntax {

struct LexerRule;  // internal

/// A token of a logical line: its type in the grammar, and its place in the line's text.
struct LexedToken {
  std::size_t type = 0;
  std::size_t begin = 0;
  std::size_t end = 0;  ///< the offset after its last character

  bool operator==(const LexedToken&) const = default;
};

/// Cuts one logical line into tokens by the rules of `RobdefLexer.g4`.
///
/// The rules are those of the generated lexer, which works them out character by character, once.
/// Here its states are kept as a table, so a character costs one look into it.
class LineLexer {
 public:
  /// `text` is without the line's end; `mode` is one of the grammar's.
  LineLexer(std::string_view text, std::size_t mode) : text_(text), mode_(mode) {}

  /// The next token that is not skipped. The last one is the line's end, NL, which stands behind
  /// the text; it is not to be called after that.
  LexedToken next();

 private:
  void change_mode(const LexerRule& rule);

  std::string_view text_;
  std::size_t at_ = 0;
  std::size_t mode_;
  std::vector<std::size_t> outer_modes_ = {};
};

}  // namespace robdef::syntax
