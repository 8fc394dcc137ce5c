// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <chrono>
#include <memory>
#include <optional>
#include <string>
#include <string_view>

namespace serving {

/// How long a program serves: until SIGINT or SIGTERM comes (on Windows: until the console is told
/// to end it), and for so many seconds at most; 0 sets no limit. Made before the first node, since
/// threads that are there already would take the signals.
class Stay {
 public:
  explicit Stay(int seconds);
  ~Stay();
  Stay(const Stay&) = delete;
  Stay& operator=(const Stay&) = delete;
  /// Waits so long. False once the stay is over, without waiting.
  bool wait(std::chrono::milliseconds time);
  /// Waits for the end.
  void wait_for_end();

 private:
  struct Signals;
  std::unique_ptr<Signals> signals_;
  bool has_limit_;
  std::chrono::steady_clock::time_point end_;
  bool is_over_ = false;
};

/// The number of seconds that a word of the command line says; none when it is no such number.
std::optional<int> read_seconds(std::string_view word);

/// Prints `ready: URL`, which scripts wait for.
void announce(const std::string& url);

/// Says on standard error who can connect to a port, and how to change that: `--everywhere`.
void say_where(int port, bool is_everywhere);

}  // namespace serving
