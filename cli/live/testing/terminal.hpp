// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <fcntl.h>
#include <pty.h>
#include <signal.h>
#include <sys/wait.h>
#include <unistd.h>

#include <cstdlib>
#include <string>
#include <utility>
#include <vector>

#include "runtime/cpp/src/node/testing/pair.hpp"

namespace robdef::testing {

/// Robdef at a terminal.
class Terminal {
 public:
  explicit Terminal(std::vector<std::string> arguments) {
    arguments.insert(arguments.begin(), ROBDEF_PROGRAM);
    std::vector<char*> words;
    for (std::string& argument : arguments) words.push_back(argument.data());
    words.push_back(nullptr);
    winsize size{};
    size.ws_row = 50;
    size.ws_col = 200;
    process_ = ::forkpty(&descriptor_, nullptr, nullptr, &size);
    if (process_ == 0) {
      ::setenv("TERM", "dumb", 1);
      ::execv(words[0], words.data());
      ::_exit(127);
    }
    ::fcntl(descriptor_, F_SETFL, O_NONBLOCK);
  }
  ~Terminal() {
    if (process_ > 0) {
      ::kill(process_, SIGKILL);
      (void)end();
    }
    ::close(descriptor_);
  }
  Terminal(const Terminal&) = delete;
  Terminal& operator=(const Terminal&) = delete;

  void type(const std::string& text) {
    if (::write(descriptor_, text.data(), text.size()) < 0) std::abort();
  }
  /// Waits until the text has come, behind what was waited for before.
  bool shows(const std::string& text) {
    return rr::testing::eventually([&] {
      read();
      const std::size_t at = screen_.find(text, seen_);
      if (at == std::string::npos) return false;
      seen_ = at + text.size();
      return true;
    });
  }
  [[nodiscard]] const std::string& screen() const { return screen_; }
  /// Its exit status, -1 when a signal has ended it: one does that when it does not end itself.
  int end() {
    int status = 0;
    const auto has_ended = [&] {
      read();  // what it prints last must go somewhere
      return ::waitpid(process_, &status, WNOHANG) != 0;
    };
    if (!rr::testing::eventually(has_ended)) {
      ::kill(process_, SIGKILL);
      ::waitpid(process_, &status, 0);
    }
    process_ = -1;
    return WIFEXITED(status) ? WEXITSTATUS(status) : -1;
  }

 private:
  void read() {
    char bytes[4096];
    ssize_t count = 0;
    while ((count = ::read(descriptor_, bytes, sizeof bytes)) > 0) {
      screen_.append(bytes, static_cast<std::size_t>(count));
    }
  }

  pid_t process_ = -1;
  int descriptor_ = -1;
  std::string screen_;
  std::size_t seen_ = 0;
};

}  // namespace robdef::testing
