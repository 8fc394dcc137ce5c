// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <algorithm>
#include <cstdint>

#include "rr/mutex.hpp"
#include "runtime/cpp/src/channel/synchronization.hpp"

namespace rr::channel {

/// The turn to poll of a reactor, and how the watching thread takes it from a thread that is long
/// in a handler.
///
/// A number counts what is done with the turn: one up when a handler is entered, one when it is
/// left or the turn is taken from it. Odd while the thread that has it is in a handler. The turn is
/// taken between these two only, and from the handler that was seen. So it is with the turn that a
/// thread gets what belongs to it: the events that are still to be handled.
///
/// A watching thread that has seen nothing new for long sleeps until it is woken by the next
/// enter().
template <class Sync = Synchronization>
class PollingTurn {
 public:
  using Count = std::uint64_t;
  using Mutex = typename Sync::Mutex;
  using Condition = typename Sync::Condition;

  /// For the thread that takes the turn, under the reactor's lock, while no thread has it.
  [[nodiscard]] Count begin() const { return turn_.load(std::memory_order_relaxed); }
  /// Whether a thread that was given `own` has the turn still.
  [[nodiscard]] bool is_of(Count own) const { return turn_.load(std::memory_order_relaxed) == own; }
  /// Whether it has, and is in a handler.
  [[nodiscard]] bool is_inside(Count own) const { return own % 2 != 0 && turn_.load() == own; }

  /// By the thread that has the turn. True when the watching thread is to be woken.
  [[nodiscard]] bool enter(Count& own) {
    turn_.store(++own);
    return watcher_sleeps_.load();
  }
  /// False when the turn has been lost meanwhile.
  [[nodiscard]] bool leave(Count& own) {
    if (!take(own)) return false;
    ++own;
    return true;
  }
  /// Takes the turn out of the handler that was seen. False when that has been left, or another
  /// thread was faster.
  [[nodiscard]] bool take(Count seen) { return turn_.compare_exchange_strong(seen, seen + 1); }

  /// By the watching thread: what it compares with what it sees later.
  [[nodiscard]] Count look() const { return turn_.load(); }
  /// The watching thread waits on `woken`, with the reactor's lock: until `soon` or, if nothing new
  /// was seen for long and nothing has happened since `seen`, until `late`.
  void watch(Condition& woken, Mutex& mutex, Count seen, bool is_quiet, Time soon, Time late)
      RR_REQUIRES(mutex) {
    Time until = std::min(soon, late);
    if (is_quiet) {
      watcher_sleeps_.store(true);
      if (turn_.load() == seen) until = late;
    }
    Sync::wait_until(woken, mutex, until);
    watcher_sleeps_.store(false, std::memory_order_relaxed);
  }
  /// Wakes it, under the reactor's lock, which makes sure that it is really waiting.
  void wake_watcher(Condition& woken) {
    watcher_sleeps_.store(false, std::memory_order_relaxed);
    woken.notify_one();
  }

 private:
  typename Sync::template Atomic<Count> turn_{0};
  typename Sync::template Atomic<bool> watcher_sleeps_{false};
};

/// What the watching thread has seen of the turn.
class TurnLooks {
 public:
  using Count = std::uint64_t;

  /// `stuck`, `quiet`: after how many looks the turn counts as that.
  TurnLooks(Count turn, int stuck, int quiet) : last_(turn), stuck_(stuck), quiet_(quiet) {}
  void note(Count turn) {
    const bool is_busy = turn % 2 != 0;
    stuck_looks_ = is_busy && turn == last_ ? stuck_looks_ + 1 : 0;
    quiet_looks_ = !is_busy && turn == last_ ? quiet_looks_ + 1 : 0;
    last_ = turn;
  }
  /// In the same handler for too long.
  [[nodiscard]] bool is_stuck() const { return stuck_looks_ >= stuck_; }
  /// Nothing new for long.
  [[nodiscard]] bool is_quiet() const { return quiet_looks_ >= quiet_; }

 private:
  Count last_;
  const int stuck_;
  const int quiet_;
  int stuck_looks_ = 0;
  int quiet_looks_ = 0;
};

}  // namespace rr::channel
