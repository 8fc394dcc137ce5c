// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <cstddef>

namespace rr::codec {

/// Notified of the large blocks (smallest_large_block) that a thread takes by rr::allocate() while
/// a WatchedThread of it exists.
class LargeAllocations {
 public:
  /// Before so many bytes are allocated. What it throws comes to who wanted them.
  virtual void before(std::size_t bytes) = 0;
  /// A block of so many bytes was freed by this thread, whoever has allocated it.
  virtual void freed(std::size_t bytes) noexcept = 0;

 protected:
  ~LargeAllocations() = default;
};

/// Notifies `watch`, which may be null, of what this thread allocates from now on, instead of the
/// one before.
class WatchedThread {
 public:
  explicit WatchedThread(LargeAllocations* watch) noexcept;
  ~WatchedThread();
  WatchedThread(const WatchedThread&) = delete;
  WatchedThread& operator=(const WatchedThread&) = delete;

 private:
  LargeAllocations* const outer_;
};

}  // namespace rr::codec
