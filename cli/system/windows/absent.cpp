// SPDX-License-Identifier: Apache-2.0
// What robdef for Windows does not have yet: boards at serial ports.
#include <ostream>

#include "cli/live/board_channel.hpp"
#include "cli/recordings.hpp"

namespace robdef {

ExitStatus bridge(const Options& /*options*/, std::ostream& /*out*/, std::ostream& err) {
  err << "robdef: `bridge` needs serial ports, which robdef for Windows does not have yet\n";
  return exit_usage;
}

namespace live {

// The scheme is unknown then, which is what connecting says.
void add_board_channel(rr::NodeOptions& /*options*/) {}

}  // namespace live
}  // namespace robdef
