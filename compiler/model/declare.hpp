// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <string_view>
#include <vector>

#include "compiler/diagnostics/source.hpp"
#include "compiler/model/model.hpp"
#include "compiler/syntax/ast.hpp"

namespace robdef::model {

/// Adds the definition of a file to the model: all declarations with their names, constants with
/// their literals, enums with their values. Imports, aliases, fields and members are still missing.
/// Declarations do not move afterwards, so pointers to them may be kept.
Definition& declare(const ast::ProgramFile& written, const Source& source, Model& model);

/// The words of an option's text: `pipe`, `NAME`, `unreliable`.
std::vector<std::string_view> words_of(std::string_view text);

}  // namespace robdef::model
