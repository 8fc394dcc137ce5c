// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <atomic>
#include <cstdint>
#include <mutex>
#include <string>
#include <utility>

namespace rr::stress {

/// What a process tells its director, a line each: any thread may write.
class Lines {
 public:
  void write(const std::string& line);
  /// Something that must not be: it is told at once, since the process may be killed.
  void fault(const std::string& what) { write("fault " + what); }

 private:
  std::mutex mutex_;
};

/// Numbers of a stream that must come one after the other, from whichever is first.
class Consecutive {
 public:
  Consecutive(Lines& lines, std::string name) : lines_(lines), name_(std::move(name)) {}
  void take(std::uint64_t number) {
    const std::uint64_t last = last_.load();
    if (last != 0 && number != last + 1) {
      lines_.fault(name_ + ": " + std::to_string(number) + " came behind " + std::to_string(last));
    }
    if (last == 0) first_ = number;
    last_ = number;
  }
  /// 0: none has come.
  [[nodiscard]] std::uint64_t first() const { return first_; }
  [[nodiscard]] std::uint64_t last() const { return last_; }

 private:
  Lines& lines_;
  const std::string name_;
  std::atomic<std::uint64_t> first_{0};
  std::atomic<std::uint64_t> last_{0};
};

/// Numbers of which only the newest counts: never an older one behind a newer one. For one thread
/// at a time.
class Rising {
 public:
  Rising(Lines& lines, std::string name) : lines_(lines), name_(std::move(name)) {}
  void take(std::uint64_t number, const char* where) {
    const std::uint64_t last = last_.load();
    if (number < last) {
      lines_.fault(name_ + " (" + where + "): " + std::to_string(number) + " came behind " +
                   std::to_string(last));
    }
    last_ = number;
  }
  [[nodiscard]] std::uint64_t last() const { return last_; }

 private:
  Lines& lines_;
  const std::string name_;
  std::atomic<std::uint64_t> last_{0};
};

}  // namespace rr::stress
