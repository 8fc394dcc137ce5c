// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <string>
#include <string_view>
#include <vector>

namespace robdef::docs {

/// How a part of a documentation is meant.
enum class BlockKind {
  paragraph,
  bullets,   ///< one item for each of `lines`
  numbers,   ///< the same, counted
  verbatim,  ///< lines that were indented
};

/// A part of a documentation. Its lines are plain text.
struct Block {
  BlockKind kind{};
  std::vector<std::string> lines;

  bool operator==(const Block&) const = default;
};

/// Cuts the text of `##` lines into blocks. Empty lines separate paragraphs. Lines that begin with
/// `-`, `*` or `+` and a blank are items of a list, those that begin with `1.` or `1)` of a counted
/// one; an indented line continues the item above it. Elsewhere lines that are indented by two
/// blanks or more are verbatim. The one blank after `##` is not in the text.
std::vector<Block> blocks_of(std::string_view documentation);

}  // namespace robdef::docs
