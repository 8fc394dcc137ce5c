// SPDX-License-Identifier: Apache-2.0
#include "examples/serving/serving.hpp"

#include <charconv>
#include <cstdio>
#include <system_error>

namespace serving {

void Stay::wait_for_end() {
  while (wait(std::chrono::hours(1))) {
  }
}

std::optional<int> read_seconds(std::string_view word) {
  int seconds = 0;
  const char* const end = word.data() + word.size();
  const auto [at, error] = std::from_chars(word.data(), end, seconds);
  if (error != std::errc() || at != end || seconds < 0) return std::nullopt;
  return seconds;
}

void announce(const std::string& url) {
  std::printf("ready: %s\n", url.c_str());
  std::fflush(stdout);
}

void say_where(int port, bool is_everywhere) {
  std::fprintf(stderr, "listens at port %d of %s\n", port,
               is_everywhere ? "all interfaces" : "this machine; --everywhere opens it to others");
}

}  // namespace serving
