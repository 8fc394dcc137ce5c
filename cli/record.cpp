// SPDX-License-Identifier: Apache-2.0
#include <memory>
#include <mutex>
#include <ostream>
#include <rr/error.hpp>
#include <rr/printable.hpp>
#include <rr/tap.hpp>

#include "cli/options.hpp"
#include "cli/recordings.hpp"
#include "cli/system/end_signals.hpp"
#include "runtime/cpp/src/replay/proxy.hpp"

namespace robdef {

ExitStatus record(const Options& options, std::ostream& out, std::ostream& err) {
  const RecordingOptions& wanted = more(options).recording;
  const EndSignals signals;
  std::mutex printing;
  try {
    const auto recorder = std::make_shared<rr::Recorder>(
        wanted.output,
        rr::RecorderOptions{.when_full = wanted.drops ? rr::RecorderOptions::WhenFull::drop
                                                      : rr::RecorderOptions::WhenFull::wait,
                            .keeps_credentials = wanted.keeps_credentials});
    {
      rr::replay::Proxy proxy(recorder, rr::replay::host_port_of(wanted.connect),
                              {.port = *wanted.port,
                               .listens_everywhere = wanted.listens_everywhere,
                               .log = [&](const std::string& text) {
                                 const std::lock_guard lock(printing);
                                 err << "robdef: " << rr::printable(text) << std::endl;
                               }});
      {
        const std::lock_guard lock(printing);
        out << "recording connections to " << wanted.connect << " that come to port "
            << proxy.port() << std::endl;
        err << place_line(wanted) << std::endl;
      }
      while (!signals.wait() && recorder->failure().empty()) continue;
    }
    recorder->close();
    out << wanted.output << ": " << recorder->messages() << " messages";
    if (recorder->lost() != 0) out << ", and " << recorder->lost() << " left out";
    out << '\n';
    if (recorder->failure().empty()) return exit_fine;
    err << "robdef: " << recorder->failure() << '\n';
  } catch (const rr::Error& error) {
    err << "robdef: " << rr::printable(error.message()) << '\n';
  }
  return exit_errors;
}

}  // namespace robdef
