// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <algorithm>
#include <cctype>
#include <cstddef>
#include <string>
#include <string_view>

/// Names of errors as identifiers of the interpreter, and back. MATLAB documents an identifier as
/// two or more fields with colons between them; each begins with a letter and continues with
/// letters, digits and underscores (`MException`). The rule, which docs/howto/matlab.md states for
/// users:
///
/// - each dot of the name becomes a colon: `experimental.docs.Stuck` is `experimental:docs:Stuck`;
/// - any other character that a field cannot have becomes `_`;
/// - a field that does not begin with a letter gets an `x` in front;
/// - a name without a dot, as other languages give it, is put behind `RobotRaconteur`.
namespace rr::matlab {

namespace identifier {

inline bool is_letter(char c) { return std::isalpha(static_cast<unsigned char>(c)) != 0; }
inline bool is_word(char c) { return std::isalnum(static_cast<unsigned char>(c)) != 0 || c == '_'; }

inline bool is_field(std::string_view text) {
  return !text.empty() && is_letter(text.front()) && std::all_of(text.begin(), text.end(), is_word);
}

inline std::string field(std::string_view text) {
  std::string made(text);
  std::replace_if(
      made.begin(), made.end(), [](char c) { return !is_word(c); }, '_');
  return made.empty() || !is_letter(made.front()) ? "x" + made : made;
}

}  // namespace identifier

/// `RobotRaconteur:ConnectionError`, `example:probe:ProbeFault`.
inline std::string identifier_of(std::string_view error_name) {
  std::string made;
  std::size_t begin = 0;
  while (true) {
    const std::size_t dot = error_name.find('.', begin);
    made += identifier::field(error_name.substr(begin, dot - begin));
    if (dot == std::string_view::npos) break;
    made += ':';
    begin = dot + 1;
  }
  return made.find(':') == std::string::npos ? "RobotRaconteur:" + made : made;
}

/// The name of the error that an identifier stands for; empty for what stands for none: the
/// interpreter's own, and what has other characters. Dots are taken, too:
/// `example.probe:ProbeFault`.
inline std::string name_of_identifier(std::string_view identifier) {
  if (identifier.find(':') == std::string_view::npos) return {};
  std::string name(identifier);
  std::replace(name.begin(), name.end(), ':', '.');
  const std::string_view all = name;
  for (std::size_t begin = 0; begin <= all.size();) {
    const std::size_t dot = std::min(all.find('.', begin), all.size());
    const std::string_view field = all.substr(begin, dot - begin);
    const bool is_own = begin == 0 && (field == "Octave" || field == "MATLAB");
    if (is_own || !identifier::is_field(field)) return {};
    begin = dot + 1;
  }
  return name;
}

}  // namespace rr::matlab
