// SPDX-License-Identifier: Apache-2.0
#include "compiler/syntax/lossless.hpp"

#include <algorithm>
#include <array>

namespace robdef::ast {
namespace {

constexpr std::array<std::string_view, 22> token_names = {"keyword",         "name",
                                                          "number",          "version",
                                                          "string",          "text",
                                                          "symbol",          "comma",
                                                          "equals",          "colon",
                                                          "open_parameters", "close_parameters",
                                                          "open_array",      "close_array",
                                                          "open_container",  "close_container",
                                                          "open_modifiers",  "close_modifiers",
                                                          "open_arguments",  "close_arguments",
                                                          "open_value",      "close_value"};
static_assert(token_names.size() == static_cast<std::size_t>(TokenKind::close_value) + 1);

constexpr std::array<std::string_view, 5> line_names = {"blank", "comment", "documentation",
                                                        "statement", "unread"};
static_assert(line_names.size() == static_cast<std::size_t>(LineKind::unread) + 1);

}  // namespace

std::string_view name_of(TokenKind kind) { return token_names[static_cast<std::size_t>(kind)]; }

std::string_view name_of(LineKind kind) { return line_names[static_cast<std::size_t>(kind)]; }

const Line* LosslessText::line_at(std::uint32_t offset) const {
  const auto after =
      std::upper_bound(lines.begin(), lines.end(), offset,
                       [](std::uint32_t place, const Line& line) { return place < line.begin; });
  if (after == lines.begin() || offset >= std::prev(after)->end) return nullptr;
  return &*std::prev(after);
}

}  // namespace robdef::ast
