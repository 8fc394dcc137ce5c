// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <chrono>
#include <cstddef>
#include <memory>
#include <string>
#include <string_view>
#include <vector>

namespace robdef::system {

/// A program in a process of its own, whose standard streams are pipes of this one. It does not
/// outlive this. One thread.
class PipedProgram {
 public:
  /// Starts a program, found along PATH, with arguments and without a shell. Throws
  /// std::system_error when it cannot be started.
  explicit PipedProgram(const std::vector<std::string>& words);
  ~PipedProgram();
  PipedProgram(const PipedProgram&) = delete;
  PipedProgram& operator=(const PipedProgram&) = delete;

  struct Moved {
    std::size_t written = 0;  ///< bytes of the input that it took
    std::string_view out;     ///< what it printed; until the next move()
    std::string_view err;     ///< the same of its standard error
  };
  /// Waits until bytes can be moved, or as long as `most`, and moves some. `input` is what has not
  /// been taken yet; its standard input is closed when nothing is left.
  Moved move(std::string_view input, std::chrono::milliseconds most);

  /// Whether it may print more: until it and all that it started have closed both outputs.
  [[nodiscard]] bool says_something() const;

  /// Whether the process has ended; does not wait.
  [[nodiscard]] bool has_ended();
  /// Ends it at once.
  void end();
  /// Waits for its end. The exit status; -1 when a signal has ended it.
  int status();
  /// Waits for its end. Why it has not ended well, as "failed with exit status 7"; empty when it
  /// has.
  std::string failure();

 private:
  struct State;
  const std::unique_ptr<State> state_;
};

}  // namespace robdef::system
