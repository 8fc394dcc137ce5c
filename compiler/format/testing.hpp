// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <cstdint>
#include <string>
#include <string_view>
#include <vector>

#include "compiler/syntax/ast.hpp"

namespace robdef::format::testing {

/// A text that was read, formatted and is kept with what formatting must not change.
struct Formatted {
  explicit Formatted(std::string written);

  Sources sources;
  ast::File file;
  std::string text;                   ///< as it was
  std::string result;                 ///< as it becomes
  std::vector<std::string> codes;     ///< of all diagnostics, in order
  std::vector<std::string> tokens;    ///< `name:pan`
  std::vector<std::string> comments;  ///< without the blanks around them
  std::vector<std::string> unread;    ///< lines byte for byte
};

/// Why the lines and tokens do not cover the text as they should; empty when they do.
std::string gap_in(const ast::LosslessText& written, std::string_view text);

/// Everything but blanks and line ends.
std::string without_blanks(std::string_view text);

/// Lines that begin with `#`, counted without the parser.
std::size_t comment_lines(std::string_view text);

/// What is wrong with how this text is formatted; empty when it is idempotent and all tokens,
/// comments, diagnostics and unread lines are the same before and after.
std::string fault_of_formatting(const Formatted& before);

}  // namespace robdef::format::testing
