// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <string>
#include <string_view>

namespace robdef::cpp {

/// A line of C++ that a template has printed, broken into lines of 100 columns where it is longer:
/// a function with one statement, a constructor that does nothing, a declaration, the first line of
/// a function or class, an array with its values, a variable, or a call. Its own brackets group its
/// parts; it can be broken after them and after commas. Anything else stays as it is, also what has
/// brackets that do not close. `line` is without its line end, as is the result.
std::string broken(std::string_view line);

/// Whether a line of a text is longer than 100 columns.
bool has_long_line(std::string_view text);

/// Breaks each line of a text.
std::string broken_lines(std::string_view text);

/// The lines of a text, rows of a table with one indentation, in as many columns as are worth it.
std::string columns(std::string_view text);

}  // namespace robdef::cpp
