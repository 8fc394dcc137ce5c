// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <cstddef>
#include <memory>
#include <vector>

#include "runtime/cpp/src/channel/time.hpp"

namespace rr::channel {

/// Something that is due at a time. A member of what it belongs to.
class Timer {
 public:
  Timer() = default;
  Timer(const Timer&) = delete;
  Timer& operator=(const Timer&) = delete;

 protected:
  ~Timer() = default;
  /// On the watching thread, under no lock. Must be short and must not run user code.
  virtual void on_timer() = 0;

 private:
  friend class TimerHeap;
  static constexpr std::size_t unscheduled = static_cast<std::size_t>(-1);
  Time due_ = never;
  std::size_t place_ = unscheduled;
  std::weak_ptr<void> owner_;
};

/// Timers, the earliest first: a binary heap whose items know their places. Whoever has one guards
/// it with a lock.
class TimerHeap {
 public:
  /// A timer that is in it gets the new time; one that is due never is in no heap. True when none
  /// is due earlier.
  bool schedule(Timer& timer, std::weak_ptr<void> owner, Time when);
  /// Nothing happens when it is not in the heap.
  void cancel(Timer& timer);
  /// When the first one is due; never without any.
  [[nodiscard]] Time next_due() const { return timers_.empty() ? never : timers_.front()->due_; }

  /// One that was taken out because it is due, with what it belongs to.
  class Due {
   public:
    Due(Timer& timer, std::shared_ptr<void> owner) : timer_(timer), owner_(std::move(owner)) {}
    /// Without the lock of the heap; keeps the owner no longer. Nothing happens when that has gone.
    void run() {
      if (!owner_) return;
      timer_.on_timer();
      owner_.reset();
    }

   private:
    Timer& timer_;
    std::shared_ptr<void> owner_;
  };
  /// Of the first one, when next_due() has come.
  [[nodiscard]] Due take_first();

 private:
  void put(std::size_t place, Timer* timer);
  void sift_up(std::size_t place);
  void sift_down(std::size_t place);

  std::vector<Timer*> timers_;
};

}  // namespace rr::channel
