// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <iosfwd>
#include <string>
#include <vector>

#include "compiler/diagnostics/report.hpp"

namespace robdef {

/// The entries that each of `names` stands for: a code (`R0203`) is one entry, a rule of the
/// language description (`V12`) all entries of that rule; upper and lower case are the same. A name
/// that stands for nothing ends the search and is put into `unknown`.
std::vector<const CodeEntry*> find_entries(const std::vector<std::string>& names,
                                           std::string& unknown);

/// One line for each entry: code, rule, severity, summary.
std::string entry_list(const std::vector<const CodeEntry*>& entries);
/// Headline and explanation of each entry.
/// Groups of warnings, a line each, behind an empty line.
std::string group_list();
std::string entry_text(const std::vector<const CodeEntry*>& entries);
/// Array of objects: code, rule, severity, summary, explanation.
std::string entry_json(const std::vector<const CodeEntry*>& entries);

}  // namespace robdef
