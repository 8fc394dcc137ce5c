// SPDX-License-Identifier: Apache-2.0
#pragma once

#include "compiler/diagnostics/report.hpp"
#include "compiler/syntax/ast.hpp"

namespace robdef::syntax {

/// Warns of names and repetitions that are accepted only because existing files have them (Q04,
/// Q05, Q16, Q20, Q21).
void doubt_names(const ast::File& file, Report& report);

}  // namespace robdef::syntax
