// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <atomic>
#include <cstdint>
#include <thread>

#include "rr/mutex.hpp"
#include "runtime/cpp/src/channel/time.hpp"
#include "runtime/cpp/src/platform/shared_memory.hpp"
#include "runtime/cpp/src/platform/sleep_word.hpp"

namespace rr::channel {

/// What the hand-overs between threads are made of. They are templates over it, so that the models
/// (runtime/cpp/models) run the same lines with types that try out interleavings.
struct Synchronization {
  template <class T>
  using Atomic = std::atomic<T>;
  /// What is not atomic, and belongs to one thread at a time by another means than its type.
  template <class T>
  using Plain = T;
  using Mutex = rr::Mutex;
  using Lock = MutexLock;
  using Condition = rr::Condition;
  using SleepWord = platform::SleepWord;

  static bool sleep_on(const SleepWord& word, std::uint32_t seen, Time deadline) {
    return platform::sleep_on(word, seen, deadline);
  }
  static void wake(const SleepWord* word) { platform::wake(word); }
  /// The same on a word that two processes share, for `time` at most.
  static void sleep_on_shared(const SleepWord& word, std::uint32_t seen, Clock::duration time) {
    platform::sleep_on_shared(word, seen, time);
  }
  static void wait_until(Condition& condition, Mutex& mutex, Time deadline) RR_REQUIRES(mutex) {
    channel::wait_until(condition, mutex, deadline);
  }
  /// What was stored before, seen by whoever has seen what is stored afterwards.
  static void fence_release() { fence(std::memory_order_release); }
  /// What is loaded afterwards is not older than what was loaded before.
  static void fence_acquire() { fence(std::memory_order_acquire); }
  static Time now() { return Clock::now(); }
  static Time coarse_now() { return channel::coarse_now(); }
  static void yield() { std::this_thread::yield(); }

 private:
  static void fence(std::memory_order order) {
// The thread sanitizer of g++ does not know fences, and says so. They are for memory that two
// processes share, which it does not look at.
#if defined(__SANITIZE_THREAD__) && !defined(__clang__)
#pragma GCC diagnostic push
#pragma GCC diagnostic ignored "-Wtsan"
#endif
    std::atomic_thread_fence(order);
#if defined(__SANITIZE_THREAD__) && !defined(__clang__)
#pragma GCC diagnostic pop
#endif
  }
};

}  // namespace rr::channel
