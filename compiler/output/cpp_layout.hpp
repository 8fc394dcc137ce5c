// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <cstddef>
#include <string>
#include <string_view>
#include <vector>

/// Breaks generated C++ into lines of 100 columns as the project's clang-format style does, so that
/// formatting the output changes nothing. Results are printed behind `indent` blanks, which they do
/// not contain; their further lines are complete.
namespace robdef::cpp {

inline constexpr std::size_t line_width = 100;

std::string blanks(std::size_t count);

/// `before result name(parameters)after`: a function's declaration without its end.
struct Signature {
  std::string before = {};  ///< `virtual `, with a blank at its end
  std::string result = {};
  std::string name = {};
  std::vector<std::string> parameters = {};
  std::string after = {};  ///< ` = 0`, ` const override`, with a blank at its begin
};

/// A list that something is open for: `return rr_get<double>(`, `member, value`, `);`.
struct List {
  std::string before = {};  ///< to the opening parenthesis or brace
  std::vector<std::string> items = {};
  std::string after = {};  ///< from the closing one
};

/// `virtual double get_speed() = 0;`
std::string declaration(const Signature& signature, std::size_t indent);

/// The first line or lines of a function, to the end of its parameters.
std::string head(const Signature& signature, std::size_t indent);
/// The first line or lines of a function, to its `{`.
std::string opening(const Signature& signature, std::size_t indent);

/// A call.
std::string list(const List& list, std::size_t indent);
/// A variable with its values, `TYPE NAME{A, B};`: as a call, but one below the other where one of
/// them is `{}`. Broken before its name where the type and the name do not fit together.
std::string values(const List& list, std::size_t indent);
/// A braced list on one line or a few; of six items or more in columns.
std::string braced_list(const List& list, std::size_t indent);
/// The rows of a table: items with their commas, in as many columns as are worth it.
std::vector<std::string> table_rows(const std::vector<std::string>& items, std::size_t indent);

/// `class A : public B, public C {`: bases one below the other where they do not fit on a line.
std::string class_head(std::string_view name, const std::vector<std::string>& bases,
                       std::size_t indent);

}  // namespace robdef::cpp
