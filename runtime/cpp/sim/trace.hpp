// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <cstddef>
#include <cstdint>
#include <cstdio>
#include <string>

namespace rr::sim {

/// The latest steps of a run, for the report of a failure, and a number made of all of them.
class Trace {
 public:
  struct Step {
    std::int64_t time = 0;  ///< nanoseconds of the run
    int thread = 0;
    const char* what = nullptr;    ///< a literal
    const void* object = nullptr;  ///< mutex, word; null for none
    std::int64_t amount = 0;       ///< bytes, a descriptor, another thread
    const void* caller = nullptr;  ///< an address in the function that did it
  };

  /// Keeps as many steps as a report prints. They have memory of their own, which is always as
  /// large: a run's other memory is where it is however many are printed.
  Trace();
  ~Trace();
  Trace(const Trace&) = delete;
  Trace& operator=(const Trace&) = delete;

  void add(const Step& step) {
    steps_[count_++ & (kept_ - 1)] = step;
    hash_ = (hash_ ^ static_cast<std::uint64_t>(step.time) ^
             (static_cast<std::uint64_t>(step.thread) << 48U)) *
            0x100000001b3U;
    hash_ = (hash_ ^ static_cast<std::uint64_t>(step.amount)) * 0x100000001b3U;
  }
  [[nodiscard]] std::uint64_t hash() const { return hash_; }
  [[nodiscard]] std::uint64_t count() const { return count_; }
  /// The last `most` steps, one a line; functions by their names where the program has symbols.
  void print(std::FILE* file, std::size_t most) const;

 private:
  static constexpr std::size_t most_kept = 65'536;

  Step* const steps_;
  const std::size_t kept_;  // a power of two
  std::uint64_t count_ = 0;
  std::uint64_t hash_ = 0xcbf29ce484222325U;
};

/// The name of the function that holds an address, with source line where there is one.
std::string function_at(const void* address);

}  // namespace rr::sim
