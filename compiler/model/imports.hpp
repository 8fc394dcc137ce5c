// SPDX-License-Identifier: Apache-2.0
#pragma once

#include "compiler/diagnostics/report.hpp"
#include "compiler/diagnostics/source.hpp"
#include "compiler/model/model.hpp"
#include "compiler/model/syntax_errors.hpp"
#include "compiler/syntax/ast.hpp"

namespace robdef::model {

/// Connects each definition of the model with those that its file imports: Definition::imports.
/// Definitions stand in the order of the program's files. Reports imports that are not found (V03),
/// that go round in a circle (V04), and of a higher version (V05).
void resolve_imports(const ast::Program& program, const Sources& sources,
                     const SyntaxErrors& syntax_errors, Model& model, Report& report);

}  // namespace robdef::model
