// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <chrono>
#include <functional>
#include <memory>
#include <string_view>
#include <thread>

#include "rr/mutex.hpp"
#include "rr/timer.hpp"
#include "runtime/cpp/src/channel/reactor.hpp"

namespace rr {

/// A function of the program and when it is due. The watching thread runs the timer and hands the
/// function to a thread that may run user code; the next call is planned when this one has ended,
/// so there is one at a time.
class Timer::State final : public channel::Timer, public std::enable_shared_from_this<State> {
 public:
  struct Terms {
    std::chrono::nanoseconds delay;
    std::chrono::nanoseconds period;  ///< zero: once
    std::function<void()> work;
    std::function<void(std::string_view)> report;  ///< what `work` has thrown
  };
  State(std::shared_ptr<channel::Reactor> reactor, Terms terms);

  void start();
  void cancel();
  [[nodiscard]] bool is_running() const;

 private:
  void on_timer() override;
  void call();
  void plan_next();
  void schedule() RR_REQUIRES(mutex_);

  const std::shared_ptr<channel::Reactor> reactor_;
  const std::chrono::nanoseconds period_;
  const std::function<void(std::string_view)> report_;
  mutable Mutex mutex_;
  Condition ended_;
  std::function<void()> work_ RR_GUARDED_BY(mutex_);  // until it is called for the last time
  channel::Time due_ RR_GUARDED_BY(mutex_);
  bool has_ended_ RR_GUARDED_BY(mutex_) = false;
  std::thread::id calling_ RR_GUARDED_BY(mutex_);  // the thread that is in `work_`; none
};

}  // namespace rr
