// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <string>
#include <string_view>
#include <vector>

#include "compiler/diagnostics/report.hpp"
#include "compiler/diagnostics/source.hpp"

namespace robdef {

/// How findings are written.
enum class Format {
  text,  ///< for people: headline, place, the line with carets, help and notes
  line,  ///< one line each: `FILE(LINE,COLUMN): error: R0203 [V12] MESSAGE`
  json,  ///< for editors: one array of objects
};

/// One finding as text of several lines, each with its line end. Long lines of source are shown
/// around the place only; what is not printable is shown as a blank or `?`.
std::string to_text(const Diagnostic& diagnostic, const Sources& sources);

/// One finding as one line, with its line end.
std::string to_line(const Diagnostic& diagnostic, const Sources& sources);

/// Findings as a JSON array of objects: code, rule, severity, message, file, line, column,
/// end (line and column behind the last character), labels (file, line, column, end, text; the
/// first is the finding's own place), help, notes. Lines and columns count from 1.
std::string to_json(const std::vector<const Diagnostic*>& diagnostics, const Sources& sources);

/// Everything a report holds, in its order. Text has an empty line between two findings.
std::string render(const Report& report, const Sources& sources, Format format);

}  // namespace robdef
