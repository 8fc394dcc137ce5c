// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <iosfwd>

#include "compiler/driver/compile.hpp"
#include "compiler/driver/options.hpp"

namespace robdef {

/// Prints the nodes and services that can be found: once, or as they come and go until SIGINT or
/// SIGTERM.
ExitStatus discover(const Options& options, std::ostream& out, std::ostream& err);

}  // namespace robdef
