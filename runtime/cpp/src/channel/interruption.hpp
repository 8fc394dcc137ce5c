// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <atomic>

#include "runtime/cpp/src/channel/socket.hpp"

namespace rr::channel {

/// Ends, from another thread, what a thread waits for while it connects. Looking up a name is not
/// interrupted.
class Interruption {
 public:
  /// Throws rr::Error (system_resource_error) when there are no descriptors left.
  Interruption();
  Interruption(const Interruption&) = delete;
  Interruption& operator=(const Interruption&) = delete;

  /// From now on for ever.
  void interrupt();
  [[nodiscard]] bool is_interrupted() const { return is_interrupted_.load(); }
  /// Becomes readable when interrupted.
  [[nodiscard]] int descriptor() const { return event_.get(); }

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
  const Descriptor event_;
  std::atomic<bool> is_interrupted_{false};
};

}  // namespace rr::channel
