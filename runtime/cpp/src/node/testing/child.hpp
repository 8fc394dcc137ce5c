// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <sys/types.h>

#include <chrono>
#include <deque>
#include <string>
#include <vector>

namespace rr::testing {

/// Another process, of this program if no other is named, with a pipe each way. Is killed when it
/// is left.
class Child {
 public:
  /// Throws std::runtime_error.
  explicit Child(const std::vector<std::string>& arguments, std::string program = "/proc/self/exe");
  ~Child();
  Child(Child&& other) noexcept;
  Child& operator=(Child&&) = delete;

  /// A line that it reads. Nothing happens when it has ended.
  void tell(const std::string& command) const;
  /// The next line that begins with `word`, without it; waits some seconds at most. What comes
  /// before is dropped. Throws std::runtime_error.
  std::string wait_for(const std::string& word);
  /// What it has written since, without waiting for more.
  std::deque<std::string> take_lines();
  void signal(int number) const;
  /// SIGSTOP; returns when all of its threads have stopped.
  void stop() const;
  /// Waits for its end; false when it has not come in time. `status` is that of waitpid.
  bool wait(std::chrono::seconds limit, int& status);
  [[nodiscard]] pid_t id() const { return process_; }
  [[nodiscard]] bool has_ended() const { return process_ <= 0; }

 private:
  pid_t process_ = -1;
  int input_ = -1;                  // what it reads
  int output_ = -1;                 // what it writes
  std::string rest_;                // of a line
  std::deque<std::string> waited_;  // lines behind the one that was waited for
};

}  // namespace rr::testing
