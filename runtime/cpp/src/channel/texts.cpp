// SPDX-License-Identifier: Apache-2.0
#include "runtime/cpp/src/channel/texts.hpp"

#include <algorithm>
#include <random>

#include "runtime/cpp/src/platform/random.hpp"

namespace rr::channel {
namespace {

constexpr bool is_key_character(char c) {
  return is_letter(c) || is_digit(c) || c == '_' || c == '+' || c == '.' || c == '-';
}

}  // namespace

std::string_view trimmed(std::string_view text) {
  constexpr std::string_view blanks = " \t\r\n\v\f";
  const std::size_t begin = text.find_first_not_of(blanks);
  if (begin == std::string_view::npos) return {};
  return text.substr(begin, text.find_last_not_of(blanks) - begin + 1);
}

std::pair<std::string_view, std::string_view> split_line(std::string_view line) {
  const std::size_t colon = line.find(':');
  if (colon == std::string_view::npos) return {};
  const std::string_view key = trimmed(line.substr(0, colon));
  if (!std::all_of(key.begin(), key.end(), is_key_character)) return {};
  return {key, trimmed(line.substr(colon + 1))};
}

std::string random_letters() {
  constexpr std::string_view letters =
      "abcdefghijklmnopqrstuvwxyzABCDEFGHIJKLMNOPQRSTUVWXYZ0123456789";
  constexpr std::size_t length = 16;
  const platform::RandomNumbers random;
  std::uniform_int_distribution<std::size_t> any(0, letters.size() - 1);
  std::string text(length, '\0');
  for (char& letter : text) letter = letters[any(random)];
  return text;
}

}  // namespace rr::channel
