// SPDX-License-Identifier: Apache-2.0
#include "cli/live/line_words.hpp"

namespace robdef::live {

LineWords split_line(std::string_view line) {
  LineWords result;
  int depth = 0;
  bool is_text = false;
  bool is_escaped = false;
  for (const char letter : line) {
    const bool is_blank = letter == ' ' || letter == '\t' || letter == '\r';
    if (is_blank && depth == 0 && !is_text) {
      result.is_last_open = false;
      continue;
    }
    if (!result.is_last_open) result.words.emplace_back();
    result.is_last_open = true;
    result.words.back() += letter;
    if (is_escaped) {
      is_escaped = false;
    } else if (is_text) {
      if (letter == '"') is_text = false;
      if (letter == '\\') is_escaped = true;
    } else if (letter == '"') {
      is_text = true;
    } else if (letter == '[' || letter == '{') {
      ++depth;
    } else if ((letter == ']' || letter == '}') && depth > 0) {
      --depth;
    }
  }
  return result;
}

}  // namespace robdef::live
