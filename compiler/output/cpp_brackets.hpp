// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <cstddef>
#include <optional>
#include <string>
#include <string_view>
#include <vector>

#include "compiler/output/cpp_layout.hpp"

/// Finds the parts of a line of C++ that are in no brackets `( < { [` and no string; an arrow
/// closes none.
namespace robdef::cpp {

inline constexpr std::size_t nowhere = std::string_view::npos;

/// Where a character stands that is in no brackets, or opens or closes the outermost.
std::size_t find_outside(std::string_view text, char wanted);
/// Where the last of them stands.
std::size_t find_last_outside(std::string_view text, char wanted);
/// Where a word begins that is in no brackets: ` = `, ` : `.
std::size_t find_word(std::string_view text, std::string_view word);

/// The parts between the commas of a list.
std::vector<std::string> items_of(std::string_view text);
/// `before(items)after`, with the first brackets of this kind that are in no others: `(` or `{`.
std::optional<List> list_of(std::string_view text, char bracket = '(');

}  // namespace robdef::cpp
