// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <iosfwd>

#include "cli/options.hpp"
#include "compiler/driver/compile.hpp"

namespace robdef {

/// Prints the address of the inspector for the service at a URL, and opens it where that can be
/// seen: the page of its node, where that serves it, else the installed file.
ExitStatus show_page(const Options& options, std::ostream& out, std::ostream& err);

}  // namespace robdef
