// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <cstddef>
#include <string>
#include <string_view>

#include "rr/visibility.hpp"

/// Text of another node, for terminals and logs.
namespace RR_VISIBLE rr {

/// What becomes of line breaks and tabs.
enum class LineBreaks : bool {
  escaped,  ///< for one line of a log
  kept,     ///< for text of several lines, as a definition
};

/// How long text of another node may be in a line of a log.
inline constexpr std::size_t printable_limit = 400;
/// No limit.
inline constexpr std::size_t printable_whole = static_cast<std::size_t>(-1);

/// The text with everything escaped that does not show, moves the cursor or changes what is around
/// it: control characters and with them escape sequences (`\x1b`), what turns the direction of
/// writing or takes no room (`\u{202e}`), and bytes that are no UTF-8 (`\xc0`). What is longer than
/// `limit` bytes is cut and ends in `...`. The result is UTF-8, and the same when made printable
/// again. A backslash stays as it is.
std::string printable(std::string_view text, std::size_t limit = printable_limit,
                      LineBreaks breaks = LineBreaks::escaped);

/// JSON in which the same is escaped within its strings, as `\u202e`: the same values, and bytes
/// that are no UTF-8 replaced by U+FFFD.
std::string printable_json(std::string_view json);

}  // namespace rr
