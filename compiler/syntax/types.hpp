// SPDX-License-Identifier: Apache-2.0
#pragma once

#include "compiler/diagnostics/report.hpp"
#include "compiler/syntax/ast.hpp"

namespace robdef::syntax {

/// Checks the form of an objref's type (P29): an object or varobject, alone or with an index. False
/// after an error. Two indexes at once are accepted with a warning (Q09).
bool check_objref_type(const ast::TypeRef& type, Report& report);

/// Warns of types that are accepted only because existing files have them (Q06 to Q08, Q10).
void doubt_types(const ast::File& file, Report& report);

}  // namespace robdef::syntax
