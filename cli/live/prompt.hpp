// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <iosfwd>
#include <string>

#include "cli/live_options.hpp"
#include "compiler/driver/compile.hpp"

namespace robdef::live {

/// Reads commands from standard input, one a line, and does them over one connection, which is made
/// again when it is lost. Without a terminal the status says whether all have succeeded. Throws
/// rr::Error when the first attempt to connect fails.
ExitStatus prompt(const std::string& url, const LiveOptions& options, std::ostream& out,
                  std::ostream& err);

}  // namespace robdef::live
