// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <cstdint>
#include <string>
#include <string_view>
#include <vector>

#include "compiler/syntax/lossless.hpp"

/// The one layout of definitions (docs/reference/format.md). Blanks and blank lines are all that
/// changes: no token, comment or continuation, and no line that the parser could not read.
namespace robdef::format {

enum class Reason : std::uint8_t {
  indentation,
  spacing,
  trailing_blanks,
  missing_blank_line,
  needless_blank_line,
  missing_line_end,  ///< of the last line
};

/// The message for the user: `blank line missing above`.
std::string_view text_of(Reason reason);

/// Replaces the bytes from `begin` to `end`.
struct Edit {
  std::uint32_t begin = 0;
  std::uint32_t end = 0;
  std::string replacement;
  Reason reason{};
};

/// What has to change in a text, from front to back. Empty when it has the layout already.
std::vector<Edit> edits(const ast::LosslessText& written, std::string_view text);

/// The text after these edits.
std::string with_edits(std::string_view text, const std::vector<Edit>& edits);

}  // namespace robdef::format
