// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <signal.h>
#include <sys/wait.h>

#include <chrono>
#include <string>
#include <vector>

#include "runtime/cpp/src/node/testing/child.hpp"

namespace rr::gateway::testing {

/// Another program, found as the shell finds it, which does not outlive the thread that starts it.
class Program {
 public:
  explicit Program(const std::vector<std::string>& words) : child_(bound(words), "setpriv") {}

  /// Waits for its end; the status of waitpid, -1 when it does not end or has ended before.
  int wait() {
    int status = -1;
    return !child_.has_ended() && child_.wait(std::chrono::seconds(60), status) ? status : -1;
  }
  /// Sends the signal and waits.
  int end(int signal) {
    child_.signal(signal);
    return wait();
  }
  /// Whether it runs.
  [[nodiscard]] bool is_running() {
    int status = -1;
    return !child_.has_ended() && !child_.wait(std::chrono::seconds(0), status);
  }
  /// Lines that it has written since.
  std::deque<std::string> lines() { return child_.take_lines(); }

 private:
  /// A test that is killed leaves nothing.
  static std::vector<std::string> bound(const std::vector<std::string>& words) {
    std::vector<std::string> all{"--pdeathsig", "KILL"};
    all.insert(all.end(), words.begin(), words.end());
    return all;
  }

  rr::testing::Child child_;
};

/// Whether waitpid says that it ended by itself, with this code.
inline bool exited_with(int status, int code) {
  return status != -1 && WIFEXITED(status) && WEXITSTATUS(status) == code;
}

}  // namespace rr::gateway::testing
