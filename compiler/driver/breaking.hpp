// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <iosfwd>

#include "compiler/driver/compile.hpp"
#include "compiler/driver/options.hpp"

namespace robdef {

/// `robdef breaking OLD NEW`: prints what in the new version breaks users of the old one.
/// exit_errors when anything does, exit_usage when a version cannot be read
/// (docs/reference/breaking.md).
ExitStatus breaking_changes(const Options& options, std::ostream& out, std::ostream& err);

}  // namespace robdef
