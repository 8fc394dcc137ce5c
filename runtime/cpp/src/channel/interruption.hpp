// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <atomic>

#include "runtime/cpp/src/platform/waiting.hpp"

namespace rr::channel {

/// Ends, from another thread, what a thread waits for while it connects. Looking up a name is not
/// interrupted.
class Interruption {
 public:
  /// Throws rr::Error (system_resource_error) when there are no descriptors left.
  Interruption() : Interruption(std::error_code()) {}
  Interruption(const Interruption&) = delete;
  Interruption& operator=(const Interruption&) = delete;

  /// From now on for ever.
  void interrupt();
  [[nodiscard]] bool is_interrupted() const { return is_interrupted_.load(); }
  /// Becomes readable when interrupted.
  [[nodiscard]] int descriptor() const { return bell_.descriptor(); }

  /// While it exists, connecting on this thread can be interrupted.
  class Scope {
   public:
    explicit Scope(const Interruption& interruption);
    ~Scope();
    Scope(const Scope&) = delete;
    Scope& operator=(const Scope&) = delete;

   private:
    const Interruption* const outer_;
  };
  /// That of the calling thread's scope; null for none.
  static const Interruption* current();

 private:
  explicit Interruption(std::error_code error);

  const platform::Bell bell_;
  std::atomic<bool> is_interrupted_{false};
};

}  // namespace rr::channel
