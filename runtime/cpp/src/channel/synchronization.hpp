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
  static Time now() { return Clock::now(); }
  static Time coarse_now() { return channel::coarse_now(); }
  static void yield() { std::this_thread::yield(); }
};

}  // namespace rr::channel
