// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <atomic>
#include <memory>
#include <thread>

#include "rr/mutex.hpp"
#include "rr/stub.hpp"

namespace rr {

/// A function of the program that is called when something arrives, by one thread at a time.
struct Subscription::Handler {
 public:
  virtual ~Handler() = default;
  Handler(const Handler&) = delete;
  Handler& operator=(const Handler&) = delete;

  /// Returns when the function is not running any more, unless it is the caller. The function and
  /// what it holds are freed then, or when it returns.
  void disconnect();
  [[nodiscard]] bool is_connected() const { return (state_.load() & disconnected) == 0; }

 protected:
  Handler() = default;
  /// Calls `function`, which is or stands for the program's, unless this has been disconnected.
  /// What it throws comes out.
  template <class Function>
  void run(Function&& function) {
    if (!enter()) return;
    struct Leave {
      Handler& handler;
      ~Leave() { handler.leave(); }
    } const leave{*this};
    function();
  }
  /// Frees the program's function. Called once at most, under no lock.
  virtual void drop() = 0;

 private:
  bool enter();
  void leave();
  bool leave_disconnected();

  static constexpr unsigned running = 1;
  static constexpr unsigned disconnected = 2;

  // Whoever runs the function needs the lock only when it has been disconnected meanwhile.
  std::atomic<unsigned> state_{0};
  std::atomic<std::thread::id> runner_{};
  Mutex mutex_;
  Condition ended_;
  bool is_dropped_ RR_GUARDED_BY(mutex_) = false;
};

}  // namespace rr
