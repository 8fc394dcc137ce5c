// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <span>
#include <string_view>

/// The words of the language, in one sentence each.
namespace robdef::lsp {

struct WordHelp {
  std::string_view word;
  std::string_view help;
};

/// Keywords, built-in types and modifiers.
std::span<const WordHelp> keyword_helps();
std::span<const WordHelp> type_helps();
std::span<const WordHelp> modifier_helps();

/// Empty for any other word.
std::string_view help_of_word(std::string_view word);

}  // namespace robdef::lsp
