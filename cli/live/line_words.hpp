// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <string>
#include <string_view>
#include <vector>

namespace robdef::live {

struct LineWords {
  std::vector<std::string> words;
  /// Whether the line ends in the last word, not behind it.
  bool is_last_open = false;
};

/// Takes a line apart at blanks that stand in no brackets, braces or double quotes, so that values
/// as JSON are words: `call move [1, 2] "a text"` has four.
LineWords split_line(std::string_view line);

}  // namespace robdef::live
