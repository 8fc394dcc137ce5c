// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <algorithm>
#include <cctype>
#include <string>
#include <string_view>
#include <utility>

/// Texts of files of local nodes, announcements, web origins and fingerprints (04, section 7.2; 05,
/// section 2.1).
namespace rr::channel {

/// Of ASCII, whatever the locale.
constexpr bool is_letter(char c) { return (c >= 'a' && c <= 'z') || (c >= 'A' && c <= 'Z'); }
constexpr bool is_digit(char c) { return c >= '0' && c <= '9'; }

/// What errors show beside a URL that is none.
inline constexpr const char* url_example = "an example: rr+tcp://localhost:6257/?service=mount";

/// Without the blanks around it.
std::string_view trimmed(std::string_view text);

/// ASCII letters in lower case. Inline, since the components for TLS and web sockets use it too.
inline std::string in_lower_case(std::string_view text) {
  std::string lower(text);
  std::ranges::transform(lower, lower.begin(),
                         [](unsigned char c) { return static_cast<char>(std::tolower(c)); });
  return lower;
}

/// A line `key: value`, both trimmed. An empty key for a line that is none.
std::pair<std::string_view, std::string_view> split_line(std::string_view line);

/// Sixteen letters and digits that nobody can guess: the name of a socket, the state of a node's
/// services.
std::string random_letters();

}  // namespace rr::channel
