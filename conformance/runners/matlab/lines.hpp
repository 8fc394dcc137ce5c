// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <chrono>
#include <condition_variable>
#include <deque>
#include <mutex>
#include <optional>
#include <string>

namespace rr::conformance {

/// The lines of the standard input, which are read on a thread of their own, so that the
/// interpreter can do other things until one has come.
class Lines {
 public:
  /// The thread ends with the input.
  Lines();
  /// Nothing when none has come in time, or the input has ended.
  std::optional<std::string> take(std::chrono::milliseconds limit);
  [[nodiscard]] bool has_ended();

 private:
  void read();
  std::mutex mutex_;
  std::condition_variable changed_;
  std::deque<std::string> lines_;
  bool is_at_end_ = false;
};

}  // namespace rr::conformance
