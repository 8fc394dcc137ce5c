// SPDX-License-Identifier: Apache-2.0
#pragma once

#include "compiler/diagnostics/report.hpp"
#include "compiler/model/model.hpp"

namespace robdef::model {

/// Checks the rules of the language that need more than one line (06, section 11: V01, V02,
/// V06-V08, V11, V13-V15, V17, V23-V27) and warns about modifiers (W1-W3). Reads a model that
/// resolve(), evaluate() and lay_out() have completed; these report the remaining rules. All
/// definitions are checked, imported ones as strictly as sources.
void check(const Model& model, Report& report);

/// The strict check of the check command (T1): every definition declares version 0.9.2 or later.
void check_strictly(const Model& model, Report& report);

}  // namespace robdef::model
