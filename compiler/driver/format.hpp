// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <iosfwd>

#include "compiler/driver/compile.hpp"
#include "compiler/driver/options.hpp"

namespace robdef {

/// Lays out the given definitions (docs/reference/format.md) in their places, all or none; `-` is
/// laid out from standard input to `out`. With `--check` nothing is written: what would change goes
/// to `out`, one place a line, and the status is exit_errors when there is any. Names lines that
/// could not be read on `err`.
ExitStatus format_files(const Options& options, std::ostream& out, std::ostream& err);

}  // namespace robdef
