// SPDX-License-Identifier: Apache-2.0
#include <pthread.h>
#include <signal.h>

#include <cerrno>
#include <ctime>
#include <memory>
#include <mutex>
#include <ostream>
#include <rr/error.hpp>
#include <rr/tap.hpp>

#include "compiler/driver/recordings.hpp"
#include "runtime/cpp/src/replay/proxy.hpp"

namespace robdef {
namespace {

// The signals that ask the program to end are taken by whoever waits for them here, while this
// lives. To be made before any thread is.
class EndSignals {
 public:
  EndSignals() {
    sigemptyset(&signals_);
    sigaddset(&signals_, SIGINT);
    sigaddset(&signals_, SIGTERM);
    pthread_sigmask(SIG_BLOCK, &signals_, &before_);
  }
  ~EndSignals() { pthread_sigmask(SIG_SETMASK, &before_, nullptr); }
  EndSignals(const EndSignals&) = delete;
  EndSignals& operator=(const EndSignals&) = delete;

  // True when one came within a second.
  [[nodiscard]] bool wait() const {
    const timespec second{1, 0};
    return sigtimedwait(&signals_, nullptr, &second) > 0;
  }

 private:
  sigset_t signals_{};
  sigset_t before_{};
};

}  // namespace

ExitStatus record(const Options& options, std::ostream& out, std::ostream& err) {
  const RecordingOptions& wanted = options.recording;
  const EndSignals signals;
  std::mutex printing;
  try {
    const auto recorder = std::make_shared<rr::Recorder>(
        wanted.output,
        rr::RecorderOptions{.when_full = wanted.drops ? rr::RecorderOptions::WhenFull::drop
                                                      : rr::RecorderOptions::WhenFull::wait});
    {
      rr::replay::Proxy proxy(recorder, rr::replay::host_port_of(wanted.connect),
                              {.port = *wanted.port,
                               .listens_everywhere = wanted.listens_everywhere,
                               .log = [&](const std::string& text) {
                                 const std::lock_guard lock(printing);
                                 err << "robdef: " << text << std::endl;
                               }});
      {
        const std::lock_guard lock(printing);
        out << "recording connections to " << wanted.connect << " that come to port "
            << proxy.port() << std::endl;
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
    err << "robdef: " << error.message() << '\n';
  }
  return exit_errors;
}

}  // namespace robdef
