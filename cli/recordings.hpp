// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <iosfwd>
#include <string>

#include "compiler/driver/compile.hpp"
#include "compiler/driver/options.hpp"

/// The commands about recordings (docs/howto/recording.md).
namespace robdef {

/// Prints a recording: a line or a JSON object for each record, or the summary.
ExitStatus inspect(const Options& options, std::ostream& out, std::ostream& err);
/// Records the connections that come to a port and are passed on, until SIGINT or SIGTERM.
ExitStatus record(const Options& options, std::ostream& out, std::ostream& err);
/// Plays one side of a recording and prints what differs.
ExitStatus replay(const Options& options, std::ostream& out, std::ostream& err);

/// Offers the boards of `inputs` as services, until SIGINT or SIGTERM (docs/howto/serial.md).
ExitStatus bridge(const Options& options, std::ostream& out, std::ostream& err);

}  // namespace robdef
