// SPDX-License-Identifier: Apache-2.0
#include <fmt/format.h>

#include <ostream>
#include <rr/error.hpp>

#include "cli/inspect_text.hpp"
#include "cli/options.hpp"
#include "cli/recordings.hpp"
#include "runtime/cpp/src/replay/player.hpp"

namespace robdef {

ExitStatus replay(const Options& options, std::ostream& out, std::ostream& err) {
  const RecordingOptions& wanted = more(options).recording;
  try {
    rr::replay::PlayOptions how;
    if (!wanted.connect.empty()) how.service = rr::replay::host_port_of(wanted.connect);
    how.port = wanted.port.value_or(0);
    how.listens_everywhere = wanted.listens_everywhere;
    how.connection = wanted.connection;
    how.is_fast = wanted.is_fast;
    how.tolerance = wanted.tolerance;
    how.ignored = wanted.ignored;
    how.on_listening = [&](int port) {
      out << "playing the service at port " << port << std::endl;
      err << place_line(wanted) << std::endl;
    };
    const rr::replay::PlayReport report = rr::replay::play(options.inputs.front(), how);
    for (const std::string& gap : report.gaps) err << "robdef: " << gap << '\n';
    for (const rr::replay::Difference& each : report.differences) {
      out << fmt::format("{:>12} {:>4} {}\n", seconds_text(each.time),
                         fmt::format("#{}", each.connection), each.text);
    }
    out << fmt::format("messages sent: {}, entries compared: {}, differences: {}\n", report.sent,
                       report.compared, report.differences.size());
    if (report.left_out != 0) {
      out << fmt::format("values of wires missing or too many: {}\n", report.left_out);
    }
    if (report.ignored != 0) out << fmt::format("entries ignored: {}\n", report.ignored);
    return report.differences.empty() ? exit_fine : exit_errors;
  } catch (const rr::Error& error) {
    err << "robdef: " << error.message() << '\n';
    return exit_errors;
  }
}

}  // namespace robdef
