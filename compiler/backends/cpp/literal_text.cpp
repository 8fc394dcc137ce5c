// SPDX-License-Identifier: Apache-2.0
#include "compiler/backends/cpp/literal_text.hpp"

#include <algorithm>
#include <cstddef>

#include "compiler/backends/cpp/constants.hpp"

namespace robdef::cpp {
namespace {

// Compilers need not accept longer literals.
constexpr std::size_t piece_limit = 16 * 1024;

bool is_plain(char c) { return c == '\n' || c == '\t' || (c >= ' ' && c <= '~'); }

/// A delimiter that the text does not hold.
std::string delimiter_for(std::string_view text) {
  std::string delimiter = "robdef";
  while (text.find(")" + delimiter + "\"") != std::string_view::npos) delimiter += '_';
  return delimiter;
}

std::string raw(std::string_view text) {
  const std::string delimiter = delimiter_for(text);
  return "R\"" + delimiter + "(" + std::string(text) + ")" + delimiter + "\"";
}

/// Bytes as octal escapes.
std::string escaped(std::string_view text) {
  std::string result = "\"";
  for (const char c : text) {
    const auto byte = static_cast<unsigned char>(c);
    if (c == '\r') {
      result += "\\r";
    } else if (c == '\n') {
      result += "\\n";
    } else {
      result += '\\';
      for (const int shift : {6, 3, 0}) result += static_cast<char>('0' + ((byte >> shift) & 7));
    }
  }
  return result + '"';
}

/// How much of `text` is all plain or all not; the latter takes the line end after a carriage
/// return.
std::size_t run_length(std::string_view text, bool plain) {
  std::size_t length = 0;
  while (length < text.size() && is_plain(text[length]) == plain) ++length;
  if (!plain && length < text.size() && text[length - 1] == '\r' && text[length] == '\n') ++length;
  return length;
}

/// A good end for a long piece: behind a line.
std::size_t piece_length(std::string_view text) {
  if (text.size() <= piece_limit) return text.size();
  const std::size_t line_end = text.substr(0, piece_limit).rfind('\n');
  return line_end == std::string_view::npos ? piece_limit : line_end + 1;
}

}  // namespace

std::vector<std::string> literal_text(std::string_view text) {
  std::vector<std::string> pieces;
  while (!text.empty()) {
    const bool plain = is_plain(text.front());
    // No more of a long text than a piece takes, or each piece reads all of the rest.
    std::size_t length = run_length(plain ? text.substr(0, piece_limit + 1) : text, plain);
    if (plain) length = piece_length(text.substr(0, length));
    pieces.push_back(plain ? raw(text.substr(0, length)) : escaped(text.substr(0, length)));
    text.remove_prefix(length);
  }
  if (pieces.empty()) pieces.emplace_back("\"\"");
  return pieces;
}

}  // namespace robdef::cpp
