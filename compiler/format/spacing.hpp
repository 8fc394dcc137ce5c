// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <string_view>
#include <vector>

#include "compiler/format/format.hpp"

namespace robdef::format {

/// Adds what has to change inside of a statement: indentation, blanks between tokens and behind
/// them. Nothing where blanks could not be moved without changing what the line says.
void lay_out_statement(const ast::LosslessText& written, const ast::Line& line,
                       std::string_view text, std::vector<Edit>& edits);

/// Adds an edit unless these bytes read so already.
void put(std::uint32_t begin, std::uint32_t end, std::string replacement, Reason reason,
         std::string_view text, std::vector<Edit>& edits);

/// The blanks before a line.
std::string indentation_of(const ast::Line& line);

/// Offset of the line's end, where its carriage returns begin; line.end where there is none.
std::uint32_t content_end(const ast::Line& line, std::string_view text);

}  // namespace robdef::format
