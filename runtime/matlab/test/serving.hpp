// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <charconv>
#include <csignal>
#include <cstdio>
#include <cstring>
#include <exception>
#include <string_view>

/// What services have in common that tests in Octave start: `[--port N] [--seconds N]`.
namespace rr::matlab::testing {

struct Options {
  int port = 0;
  int seconds = 100;
};

inline bool read(int argc, char** argv, Options& options) {
  for (int i = 1; i < argc; i += 2) {
    const std::string_view name = argv[i];
    int* const value = name == "--port"      ? &options.port
                       : name == "--seconds" ? &options.seconds
                                             : nullptr;
    if (value == nullptr || i + 1 == argc) return false;
    const char* const end = argv[i + 1] + std::strlen(argv[i + 1]);
    if (std::from_chars(argv[i + 1], end, *value).ptr != end) return false;
  }
  return options.port >= 0 && options.port <= 65535;
}

/// Says `ready: PORT` once `start(port)` has given it, and waits for a signal or the end of the
/// time.
template <class Start>
int serve(int argc, char** argv, const Start& start) try {
  Options options;
  if (!read(argc, argv, options)) {
    std::fprintf(stderr, "usage: %s [--port N] [--seconds N]\n", argv[0]);
    return 2;
  }
  // Blocked before the node starts its threads, so that only the wait below takes them.
  sigset_t stop;
  sigemptyset(&stop);
  sigaddset(&stop, SIGINT);
  sigaddset(&stop, SIGTERM);
  pthread_sigmask(SIG_BLOCK, &stop, nullptr);
  const auto served = start(options.port);
  std::printf("ready: %d\n", static_cast<int>(served->port));
  std::fflush(stdout);
  const timespec time{options.seconds, 0};
  sigtimedwait(&stop, nullptr, &time);
  return 0;
} catch (const std::exception& error) {
  std::fprintf(stderr, "%s: %s\n", argv[0], error.what());
  return 1;
}

}  // namespace rr::matlab::testing
