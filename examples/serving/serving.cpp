// SPDX-License-Identifier: Apache-2.0
#include "examples/serving/serving.hpp"

#include <algorithm>
#include <charconv>
#include <cstdio>
#include <ctime>
#include <system_error>

namespace serving {

using std::chrono::steady_clock;

Stay::Stay(int seconds)
    : has_limit_(seconds > 0), end_(steady_clock::now() + std::chrono::seconds(seconds)) {
  sigemptyset(&signals_);
  sigaddset(&signals_, SIGINT);
  sigaddset(&signals_, SIGTERM);
  pthread_sigmask(SIG_BLOCK, &signals_, nullptr);
}

bool Stay::wait(std::chrono::milliseconds time) {
  if (is_over_) return false;
  auto until = steady_clock::now() + time;
  if (has_limit_) until = std::min(until, end_);
  const auto left = std::max(until - steady_clock::now(), steady_clock::duration::zero());
  const auto seconds = std::chrono::floor<std::chrono::seconds>(left);
  const timespec limit{static_cast<std::time_t>(seconds.count()),
                       static_cast<long>(std::chrono::nanoseconds(left - seconds).count())};
  // What comes of it otherwise, a handled signal of another kind, only makes this wait shorter.
  is_over_ =
      sigtimedwait(&signals_, nullptr, &limit) > 0 || (has_limit_ && steady_clock::now() >= end_);
  return !is_over_;
}

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
