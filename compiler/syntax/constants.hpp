// SPDX-License-Identifier: Apache-2.0
#pragma once

#include "compiler/diagnostics/report.hpp"
#include "compiler/syntax/ast.hpp"

namespace robdef::syntax {

/// Checks that a constant may have its type and that the value fits it (P30). False after an error.
/// Warns of what is accepted only because existing files have it (Q11 to Q15, Q23, Q24).
bool check_constant(const ast::Constant& constant, Report& report);

/// Checks the numbers of an enum: P32 (first one explicit), P33 (32 bits), P34 (unique), Q18
/// (wraps). Where values are missing because a line could not be read, numbers that follow from
/// them are not looked at.
void check_enum(const ast::Enum& enumeration, bool is_whole, Report& report);

}  // namespace robdef::syntax
