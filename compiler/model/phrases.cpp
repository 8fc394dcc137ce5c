// SPDX-License-Identifier: Apache-2.0
#include "compiler/model/phrases.hpp"

#include <cstddef>

namespace robdef::model {

std::string in_ticks(std::string_view name) { return '`' + std::string(name) + '`'; }

std::string listed(const std::vector<std::string>& names) {
  std::string text;
  for (std::size_t i = 0; i < names.size(); ++i) {
    if (i > 0) text += i + 1 == names.size() ? " and " : ", ";
    text += in_ticks(names[i]);
  }
  return text;
}

std::string with_article(std::string_view noun) {
  const bool is_vowel = std::string_view("aeio").find(noun.front()) != std::string_view::npos;
  return (is_vowel ? "an " : "a ") + std::string(noun);
}

}  // namespace robdef::model
