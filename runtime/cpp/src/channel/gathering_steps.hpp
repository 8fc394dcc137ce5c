// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <atomic>
#include <chrono>
#include <cstddef>
#include <cstdint>
#include <utility>

#include "rr/mutex.hpp"
#include "runtime/cpp/src/channel/time.hpp"

namespace rr::channel {

/// What has become of the call of one of several callers.
enum class Corked : std::uint8_t {
  no,      ///< its thread is to send it
  first,   ///< gathered; its thread waits for the others in uncork(), and then flushes
  joined,  ///< gathered; the first one's thread sends it
};

/// How callers that were woken together leave their calls in a send queue, for one of them to send.
/// See SendQueue. These are functions of the queue, which has the locks and what is gathered.
template <class Queue>
struct GatheringSteps {
  using Sync = typename Queue::Sync;
  using Lock = typename Sync::Lock;

  /// `expected`: callers that were woken together and have not called again.
  template <class Writer>
  static Corked cork(Queue& queue, Writer& message, unsigned expected);
  /// Returns when no expected caller has called for as long as these need to get a processor.
  static void uncork(Queue& queue, const typename Sync::template Atomic<unsigned>& expected);
  /// What was gathered is next.
  static void take_gathered(Queue& queue) RR_REQUIRES(queue.mutex_);
};

// Only the first looks whether it may wait.
template <class Queue>
template <class Writer>
Corked GatheringSteps<Queue>::cork(Queue& queue, Writer& message, unsigned expected) {
  const Lock lock(queue.gathering_);
  if (!queue.has_room_for(message)) return Corked::no;
  if (!queue.is_corked_) {
    const Time crowded_until = queue.crowded_until_;
    if (expected == 0 || queue.has_unsent_ || Sync::now() < crowded_until) return Corked::no;
    queue.missing_ = (expected + 1) / 2;
  } else if (queue.missing_ != 0 && --queue.missing_ == 0) {
    return Corked::no;  // with what the others have left
  }
  queue.gather(message);
  return std::exchange(queue.is_corked_, true) ? Corked::joined : Corked::first;
}

// Those expected are ready to run, maybe on this thread's processor. It is not given up for a while
// where something else has kept it for long.
template <class Queue>
void GatheringSteps<Queue>::uncork(Queue& queue,
                                   const typename Sync::template Atomic<unsigned>& expected) {
  constexpr Milliseconds long_turn{1};
  constexpr Milliseconds crowded_for{50};
  Time before = Sync::now();
  std::size_t gathered = 0;
  while (expected.load(std::memory_order_relaxed) != 0) {
    const std::size_t now_gathered = queue.gathered_bytes();
    if (now_gathered == gathered) break;  // none has come
    gathered = now_gathered;
    Sync::yield();
    const Time now = Sync::now();
    if (now - before > long_turn) queue.crowded_until_ = now + crowded_for;
    before = now;
  }
  const Lock lock(queue.gathering_);
  queue.is_corked_ = false;
}

template <class Queue>
void GatheringSteps<Queue>::take_gathered(Queue& queue) {
  if (!queue.has_gathered()) return;
  const Lock lock(queue.gathering_);
  queue.move_gathered();
}

}  // namespace rr::channel
