// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <functional>
#include <string>

#include "compiler/diagnostics/report.hpp"
#include "compiler/model/model.hpp"

namespace robdef {

/// What one language cannot express beyond what no language can.
struct ValueRules {
  std::string language;  ///< `C++`
  /// What is wrong with a type, as in "an array of ... "; empty for nothing.
  std::function<std::string(const model::Type&)> judge;
};

/// Reports R0902 for what is correct in a definition but cannot be generated: objects as values,
/// constants that are containers, namedarrays without numbers, and what the rules refuse.
void check_values(const model::Definition& definition, const ValueRules& rules, Report& report);

}  // namespace robdef
