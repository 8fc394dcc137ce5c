// SPDX-License-Identifier: Apache-2.0
#pragma once

#include "compiler/lsp/analysis.hpp"
#include "compiler/lsp/protocol.hpp"
#include "compiler/lsp/workspace.hpp"

namespace robdef::lsp {

/// The diagnostics of an analysed file, as the client shows them; those of its imports are shown
/// with the imports.
Json diagnostics_of(const Analysis& analysis, const Workspace& workspace, Encoding encoding);

/// Quick fixes: for each diagnostic that touches a range, the changes that its helps ask for.
Json code_actions(const Analysis& analysis, const Workspace& workspace, const Range& range,
                  Encoding encoding);

}  // namespace robdef::lsp
