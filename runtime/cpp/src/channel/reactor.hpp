// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <atomic>
#include <condition_variable>
#include <cstddef>
#include <cstdint>
#include <deque>
#include <functional>
#include <list>
#include <memory>
#include <mutex>
#include <thread>
#include <vector>

#include "runtime/cpp/src/channel/flusher.hpp"
#include "runtime/cpp/src/channel/late_work.hpp"
#include "runtime/cpp/src/channel/time.hpp"

struct epoll_event;

namespace rr::channel {

/// Something with a file descriptor that the reactor watches.
class Pollable {
 public:
  /// On the polling thread: what epoll says, edge-triggered. May run user code.
  virtual void on_ready(std::uint32_t events) = 0;
  /// While on_ready() has been in user code for long on another thread: what was held back to leave
  /// together with more is to leave now.
  virtual void on_stuck() {}

 protected:
  ~Pollable() = default;
};

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
  friend class Reactor;
  static constexpr std::size_t unscheduled = static_cast<std::size_t>(-1);
  Time due_ = never;
  std::size_t place_ = unscheduled;
  std::weak_ptr<void> owner_;
};

/// Waits for many descriptors with few threads.
///
/// One thread polls and handles what it finds in place, so that a request costs one epoll_wait, one
/// recv and one send. Another watches it: when the polling thread has been inside user code for
/// some milliseconds, the watching one takes over polling, and a third, made when there is none,
/// watches. A slow handler therefore holds up nobody but its own client. The watching thread also
/// runs the timers, so that polling needs no time-outs; it sleeps while there is nothing to watch.
///
/// A thread that has found one busy connection alone may stay with it, in receive calls that block,
/// which are a third cheaper than epoll's; somebody else polls from then on.
class Reactor {
 public:
  explicit Reactor(unsigned max_threads);
  ~Reactor();
  Reactor(const Reactor&) = delete;
  Reactor& operator=(const Reactor&) = delete;

  /// Starts the threads unless they run. Throws std::system_error.
  void start();
  /// Waits until all threads have ended and posted work is done; handlers that run are waited for.
  /// Not from one of them.
  void stop();
  /// True on a thread that belongs to this reactor, work posted after stop() included.
  [[nodiscard]] bool is_own_thread() const;

  // The descriptor's interest: EPOLL bits, to which edge-triggered is added. Throw
  // std::system_error.
  void add(int descriptor, std::uint32_t events, Pollable& pollable);
  void change(int descriptor, std::uint32_t events, Pollable& pollable);
  void remove(int descriptor);
  /// Keeps what is no longer watched until no event can name it any more.
  void retire(std::shared_ptr<void> pollable);

  /// Runs `work` soon: on the polling thread or, once the threads have been told to stop, on one
  /// that is made for it. Never in place. May run user code.
  void post(std::function<void()> work);

  // A connection counts from when it has a receiver until it has told that one of its end.
  void begin_connection();
  void end_connection();
  /// Waits until there is none. Not from a thread of the reactor.
  void wait_for_connections();

  /// Sends what streams leave behind; see Flusher. Stops when this does.
  [[nodiscard]] Flusher& flusher() { return flusher_; }

  /// Makes a timer due at `when`, unless its owner has gone by then; replaces an earlier `when`.
  void schedule(Timer& timer, std::weak_ptr<void> owner, Time when);
  void cancel(Timer& timer);

  /// To be called before a thread waits for something that another thread may have to bring: if it
  /// is a reactor's polling thread, another one polls from now on.
  static void about_to_wait();

  /// On the polling thread, while it handles an event: true when another one polls from now on, and
  /// this one may receive for the event's connection alone, until end_stay(). False when there
  /// were events of others, too, or threads are needed for other things.
  bool begin_stay();
  void end_stay();
  /// True when threads that stay are to come back soon.
  [[nodiscard]] bool is_stay_over() const { return is_stay_over_.load(std::memory_order_relaxed); }
  /// How many threads stay. For tests.
  [[nodiscard]] unsigned stays() const;

 private:
  struct Polling;  // what a thread knows while it polls
  static thread_local Polling* current_polling;
  static thread_local const Reactor* current_reactor;

  void run_thread();
  void poll(std::uint64_t turn);
  bool watch(std::unique_lock<std::mutex>& lock);
  bool take_over(std::uint64_t turn);
  bool hand_over(const Polling& polling);
  [[nodiscard]] bool has_spare_thread();
  void enter(const Polling& polling, Pollable* pollable);
  bool leave(const Polling& polling);
  bool handle_events(const Polling& polling);
  bool run_posted(const Polling& polling);
  void add_thread();
  void need_thread();
  void reap();
  void wake_watching_thread();
  void wake_polling_thread();
  Time run_timers(std::unique_lock<std::mutex>& lock);
  void sift_up(std::size_t place);
  void sift_down(std::size_t place);
  void put(std::size_t place, Timer* timer);
  void take_out(Timer& timer);

  const unsigned max_threads_;
  const unsigned max_stays_;
  Flusher flusher_;
  int epoll_ = -1;
  int wake_ = -1;

  // Whose turn it is to poll, times two, plus one while the thread is inside a handler.
  std::atomic<std::uint64_t> turn_{0};
  std::atomic<std::uint64_t> handled_{0};  // counts entries into handlers
  std::atomic<bool> watching_thread_sleeps_{false};
  std::atomic<bool> has_work_{false};  // posted or retired

  // Of the thread whose turn it is; handed over with turn_.
  static constexpr std::size_t events_at_once = 64;
  std::unique_ptr<epoll_event[]> events_;
  std::size_t next_event_ = 0;
  std::size_t event_count_ = 0;
  Pollable* handling_ = nullptr;

  mutable std::mutex mutex_;
  std::condition_variable idle_;
  std::condition_variable watch_;
  std::atomic<bool> is_stopping_{false};  // written under mutex_
  bool has_ended_ = false;                // no thread is left that could name what is retired
  bool is_polled_ = false;
  bool is_watched_ = false;
  unsigned idle_threads_ = 0;
  unsigned wanted_threads_ = 0;  // idle ones that have been woken
  unsigned live_threads_ = 0;
  unsigned stays_ = 0;
  std::atomic<bool> is_stay_over_{false};  // written under mutex_
  std::list<std::thread> threads_;
  std::vector<std::thread::id> ended_;
  std::vector<Timer*> timers_;  // a heap, earliest first
  std::deque<std::function<void()>> posted_;
  std::vector<std::shared_ptr<void>> retired_;
  std::size_t connections_ = 0;
  std::condition_variable no_connection_;
  LateWork late_;  // what is posted from is_stopping_ on
};

}  // namespace rr::channel
