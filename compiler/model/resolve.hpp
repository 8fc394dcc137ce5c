// SPDX-License-Identifier: Apache-2.0
#pragma once

#include "compiler/diagnostics/report.hpp"
#include "compiler/diagnostics/source.hpp"
#include "compiler/model/model.hpp"
#include "compiler/syntax/ast.hpp"

namespace robdef::model {

/// Gives each written name the definition it stands for: the model of a program, one definition for
/// each file in load order. Values of constants, numbers of enum values and sizes are still
/// missing: evaluate() and lay_out() add them. The model keeps nothing of the program.
///
/// Reports imports (V03-V05), using (V10), unknown types and objects (V12, V16, V24). What could
/// not be resolved is Unknown and has been reported.
Model resolve(const ast::Program& program, const Sources& sources, Report& report);

/// What the modifiers of a member mean: unknown ones, ones of another kind of member and ones with
/// arguments mean nothing; of a contradiction readonly and nolock win (06, section 6).
Access access_of(MemberKind kind, const std::vector<Modifier>& modifiers);
/// Whether the kind of member knows the modifier (06, section 6).
bool knows_modifier(MemberKind kind, std::string_view modifier);

}  // namespace robdef::model
