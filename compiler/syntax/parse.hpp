// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <string_view>

#include "compiler/diagnostics/report.hpp"
#include "compiler/diagnostics/source.hpp"
#include "compiler/syntax/ast.hpp"

namespace robdef::ast {

/// Reads one definition. Every mistake of the L, P and S rules is reported, in one run: a line that
/// cannot be read is left out, and reading goes on with the next. Warns of `option` (W4) and of
/// what is accepted only because existing files have it (Q rules). Looks nothing up.
/// Safe to call from several threads with different reports.
File parse(const Source& source, SourceId id, Report& report);

/// What was read of an earlier version of a text.
struct EarlierFile {
  std::string_view text;
  File file;
};

/// The same result in less time, if much of the text is in an earlier version, too: parts move from
/// there, so what is left of it is good for nothing.
File parse(const Source& source, SourceId id, Report& report, EarlierFile earlier);

}  // namespace robdef::ast
