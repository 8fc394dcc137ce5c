// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <iosfwd>

#include "compiler/lsp/workspace.hpp"

namespace robdef::lsp {

/// Serves one client until it says `exit` or the stream ends. Messages are read ahead by a thread
/// of their own, so that a request can be cancelled while it waits, and diagnostics are made once
/// for several edits. Returns the exit status of the program: 0 after `shutdown`, else 1.
int serve(WorkspaceOptions options, std::istream& in, std::ostream& out);

}  // namespace robdef::lsp
