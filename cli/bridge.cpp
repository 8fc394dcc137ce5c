// SPDX-License-Identifier: Apache-2.0
#include <mutex>
#include <ostream>
#include <rr/error.hpp>
#include <rr/node.hpp>
#include <rr/printable.hpp>
#include <rr/serial.hpp>

#include "cli/options.hpp"
#include "cli/recordings.hpp"
#include "cli/system/end_signals.hpp"

namespace robdef {

ExitStatus bridge(const Options& options, std::ostream& out, std::ostream& err) {
  const RecordingOptions& wanted = more(options).recording;
  const EndSignals signals;
  std::mutex printing;
  try {
    rr::Node node({.name = "robdef.bridge", .tls = more(options).live.tls.options()});
    rr::BoardBridge boards(node, [&](const std::string& text) {
      const std::lock_guard lock(printing);
      err << "robdef: " << rr::printable(text) << std::endl;
    });
    for (const std::string& board : options.inputs) boards.add(rr::BoardPlace::parse(board));
    const std::uint16_t port =
        node.listen_tcp(*wanted.port, wanted.listens_everywhere ? "*" : "localhost");
    {
      const std::lock_guard lock(printing);
      out << "boards are offered at port " << port << std::endl;
      err << place_line(wanted) << std::endl;
    }
    while (!signals.wait()) continue;
    return exit_fine;
  } catch (const rr::Error& error) {
    err << "robdef: " << rr::printable(error.message()) << '\n';
  }
  return exit_errors;
}

}  // namespace robdef
