// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <iosfwd>

#include "compiler/driver/compile.hpp"

namespace robdef {

/// `robdef lsp`: serves an editor at standard input and `out` until it ends the session. exit_fine
/// if the editor has said so before, else exit_errors.
ExitStatus serve_editor(const Options& options, std::ostream& out);

}  // namespace robdef
