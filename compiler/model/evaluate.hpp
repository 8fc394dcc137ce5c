// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <optional>
#include <string_view>

#include "compiler/diagnostics/report.hpp"
#include "compiler/model/model.hpp"

namespace robdef::model {

/// Gives constants and enum values their values. Reports struct constants that refer to nothing or
/// to themselves (V09). Literals that do not fit their type were reported by the parser and are 0.
void evaluate(Model& model, Report& report);

/// The value of a number literal (06, section 3: int or hex for integers, else float) in a type:
/// signed integers as int64, unsigned ones as uint64 (negative ones wrapped in the width of the
/// type, Q13), double and single as double (single rounded to its precision; too small ones are 0
/// or subnormal, Q24). Nothing when it does not fit, or for a type that no number literal has.
std::optional<Number> number_of(Primitive type, std::string_view literal);

}  // namespace robdef::model
