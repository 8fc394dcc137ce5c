// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <string>

#include "compiler/diagnostics/source.hpp"
#include "compiler/syntax/ast.hpp"

namespace robdef::ast {

/// A file as indented text, one node a line, each with the place of its name as `line:column`. Made
/// for tests: everything that the tree holds is there, and nothing else.
std::string dump(const File& file, const Source& source);

}  // namespace robdef::ast
