// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <string>
#include <string_view>

namespace robdef {

/// How the texts of C++, C# and JSON write a character that has an escape of its own, as `\n`;
/// empty for the others.
constexpr std::string_view named_escape(char c) {
  switch (c) {
    case '"':
      return "\\\"";
    case '\\':
      return "\\\\";
    case '\n':
      return "\\n";
    case '\r':
      return "\\r";
    case '\t':
      return "\\t";
    default:
      return {};
  }
}

/// What stands in such a text for itself, unless it has an escape of its own.
constexpr bool is_printable(char c) {
  const auto byte = static_cast<unsigned char>(c);
  return byte >= 0x20 && byte != 0x7F;
}

/// Adds a character as C# and JSON write it: by its escape, or as `\u001f` with these hexadecimal
/// digits.
inline void append_escaped(std::string& out, char c, std::string_view digits) {
  const std::string_view escape = named_escape(c);
  if (!escape.empty()) {
    out += escape;
  } else if (is_printable(c)) {
    out += c;
  } else {
    const auto byte = static_cast<unsigned char>(c);
    out += "\\u00";
    out += digits[byte / 16];
    out += digits[byte % 16];
  }
}

}  // namespace robdef
