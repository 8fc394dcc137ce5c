// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <chrono>
#include <cstddef>
#include <deque>
#include <thread>
#include <utility>

#include "rr/function.hpp"
#include "rr/mutex.hpp"

namespace rr::gateway {

/// The thread that has the state of a gateway to itself: all that happens is posted to it, so
/// nothing there needs a lock. Any thread may use it.
class Worker {
 public:
  using Task = Function<void()>;

  /// From start() on calls `tick` every `period`, and what is posted in its order.
  Worker(std::chrono::milliseconds period, Task tick) : period_(period), tick_(std::move(tick)) {}
  /// As stop().
  ~Worker() { stop(); }
  Worker(const Worker&) = delete;
  Worker& operator=(const Worker&) = delete;

  /// Once.
  void start();
  /// Does not wait.
  void post(Task task);
  /// Waits while `limit` tasks wait, so that what arrives from a robot is not read faster than it
  /// is logged. Not on the worker's thread.
  void post_in_turn(Task task, std::size_t limit = 1'000);
  /// Whether post_in_turn() waits, which it does at first. While the worker waits for handlers that
  /// may be in it, it must not.
  void set_bounded(bool is_bounded);
  /// False when so many tasks wait that what a broker sends had better be left out.
  [[nodiscard]] bool has_room() const;
  /// Ends the thread: tasks that wait, and those posted from now on, are dropped.
  void stop();

 private:
  void run();

  std::chrono::milliseconds period_;
  Task tick_;
  mutable Mutex mutex_;
  Condition changed_;
  Condition taken_;
  std::deque<Task> tasks_ RR_GUARDED_BY(mutex_);
  bool ends_ RR_GUARDED_BY(mutex_) = false;
  bool is_bounded_ RR_GUARDED_BY(mutex_) = true;
  std::thread thread_;
};

}  // namespace rr::gateway
