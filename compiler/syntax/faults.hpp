// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <cstddef>
#include <vector>

#include "compiler/diagnostics/report.hpp"
#include "compiler/syntax/lines.hpp"

namespace robdef::syntax {

/// A token of a logical line: its type in the grammar, and its offsets in the line.
struct FaultToken {
  std::size_t type = 0;
  std::size_t begin = 0;
  std::size_t end = 0;
};

/// The place at which a logical line stopped to fit the grammar.
struct Fault {
  std::vector<std::size_t> rules;  ///< rules of the grammar that were being read, innermost first
  std::size_t rule_begin = 0;      ///< where the innermost one began
  std::size_t keyword = 0;         ///< type of the line's first token
  FaultToken token;                ///< the first one that does not fit
  FaultToken previous;
  FaultToken before_previous;
};

/// Says in the words of the language what is wrong with a line: one finding of the rule that is
/// broken (L5, L6, P03, P06, P09, P11, P13, P15, P16, P18, P20, P22 to P28, P30, P31).
void report_fault(const Fault& fault, const LogicalLine& line, Report& report);

}  // namespace robdef::syntax
