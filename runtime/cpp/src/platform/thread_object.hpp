// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <new>

namespace rr::platform {

/// What is linked into a list of the calling thread. `end` is called when that thread ends, the
/// last link first.
struct ThreadEnd {
  void (*end)(ThreadEnd& link) noexcept = nullptr;
  ThreadEnd* next = nullptr;  ///< of at_thread_end()
};

/// Keeps `link` until the calling thread ends, then calls its `end`. Where the system has no memory
/// for that, the link is never ended.
void at_thread_end(ThreadEnd& link) noexcept;

/// The calling thread's T: made at its first use, destroyed when the thread ends. Null when there
/// is no memory for it. `Tag` tells objects of one type apart.
///
/// To be used instead of a `thread_local` object with a destructor: g++ 12 for Windows gives the
/// memory of these back before their destructors run.
template <class T, class Tag = T>
[[nodiscard]] T* thread_object() noexcept {
  struct Kept final : ThreadEnd {
    T object{};
  };
  static constinit thread_local Kept* mine = nullptr;
  if (mine == nullptr) {
    mine = new (std::nothrow) Kept;
    if (mine == nullptr) return nullptr;
    mine->end = [](ThreadEnd& link) noexcept {
      mine = nullptr;
      delete static_cast<Kept*>(&link);
    };
    at_thread_end(*mine);
  }
  return &mine->object;
}

}  // namespace rr::platform
