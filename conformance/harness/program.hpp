// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <sys/types.h>

#include <filesystem>
#include <string>
#include <vector>

#include "conformance/harness/stream.hpp"

namespace rr::conformance {

/// Another program that runs beside the suite. What it writes goes to a file. It does not outlive
/// the thread that has started it.
class Program {
 public:
  /// Starts `words`, found as the shell finds it. Throws std::runtime_error.
  Program(std::vector<std::string> words, std::filesystem::path log);
  ~Program();
  Program(const Program&) = delete;
  Program& operator=(const Program&) = delete;

  /// Waits until it has written this text, and returns what follows in that line. Throws
  /// std::runtime_error, with all that it has written, when it ends or is silent for too long.
  std::string wait_for(const std::string& text);
  /// Asks it to end. Throws std::runtime_error, likewise, unless it runs and then ends with 0.
  void end();

 private:
  [[nodiscard]] std::string written() const;
  [[nodiscard]] bool has_ended();
  [[noreturn]] void fail(const std::string& what) const;

  const std::string name_;
  const std::filesystem::path log_;
  pid_t process_ = -1;
  int status_ = 0;  // of waitpid, once it has ended
};

}  // namespace rr::conformance
