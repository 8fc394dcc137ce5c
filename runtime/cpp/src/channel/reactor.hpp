// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <atomic>
#include <cstddef>
#include <cstdint>
#include <deque>
#include <functional>
#include <list>
#include <memory>
#include <string>
#include <string_view>
#include <thread>
#include <vector>

#include "rr/mutex.hpp"
#include "rr/visibility.hpp"
#include "runtime/cpp/src/channel/connection_count.hpp"
#include "runtime/cpp/src/channel/flusher.hpp"
#include "runtime/cpp/src/channel/late_work.hpp"
#include "runtime/cpp/src/channel/polling_turn.hpp"
#include "runtime/cpp/src/channel/readers.hpp"
#include "runtime/cpp/src/channel/ready_events.hpp"
#include "runtime/cpp/src/channel/retired_pollables.hpp"
#include "runtime/cpp/src/channel/thread_share.hpp"
#include "runtime/cpp/src/channel/time.hpp"
#include "runtime/cpp/src/channel/timer_heap.hpp"
#include "runtime/cpp/src/channel/watcher.hpp"
#include "runtime/cpp/src/platform/poller.hpp"

namespace rr::channel {

class Metrics;

/// Something with a file descriptor that the reactor watches.
class Pollable {
 public:
  /// On the polling thread: bits of rr::channel::ready, edge-triggered. May run user code.
  virtual void on_ready(std::uint32_t events) = 0;
  /// While on_ready() has been in user code for long on another thread: what was held back to leave
  /// together with more is to leave now.
  virtual void on_stuck() {}
  /// Whose threads on_ready() takes when it blocks; null where nobody counts them.
  [[nodiscard]] virtual std::shared_ptr<ThreadShare> thread_share() const { return nullptr; }

 protected:
  ~Pollable() = default;
};

/// Waits for many descriptors with few threads.
///
/// One thread polls and handles what it finds in place, so that a request costs one wait, one
/// receive and one send. Another watches it: when the polling thread has been inside user code for
/// some milliseconds, the watching one takes over polling, and a third, made when there is none,
/// watches. A slow handler therefore holds up nobody but its own client. The watching thread also
/// runs the timers, so that polling needs no time-outs; it sleeps while there is nothing to watch.
///
/// A thread that is inside user code and does not poll any more is held, by the session whose
/// handler it is. A session holds so many at most, and those of one remote address leave some to
/// others; what comes on top waits for one to be released (thread_share.hpp).
///
/// A thread that has found one busy connection alone may stay with it, in receive calls that block,
/// which are a third cheaper than the poller's; somebody else polls from then on.
///
/// Large because the duties of its threads, polling, watching, timers, posted work and standing by,
/// pass from one thread to another under one lock, which guards the state of each.
class RR_INSIDE Reactor final : public Watcher {
 public:
  /// What a program, or a test, says of the threads.
  struct Terms {
    unsigned max_threads = 32;
    unsigned session_threads = 16;  ///< those that one session may hold
    /// Makes a thread; throws std::system_error when there can be none.
    std::function<std::thread(std::function<void()>)> make_thread{};
    /// Hears what nobody else can be told. On any thread, under no lock; must not throw.
    std::function<void(std::string_view)> report{};
    /// What the node counts; null: nothing is counted.
    std::shared_ptr<Metrics> metrics{};
  };
  explicit Reactor(unsigned max_threads) : Reactor(Terms{.max_threads = max_threads}) {}
  explicit Reactor(Terms terms);
  ~Reactor();
  Reactor(const Reactor&) = delete;
  Reactor& operator=(const Reactor&) = delete;

  /// Starts the threads unless they run. Throws std::system_error.
  void start();
  /// Waits until all threads have ended and posted work is done; handlers that run are waited for.
  /// Not from one of them.
  void stop();
  /// True once stop() has been called.
  [[nodiscard]] bool is_stopping() const;
  /// True on a thread that belongs to this reactor, work posted after stop() included.
  [[nodiscard]] bool is_own_thread() const;

  void add(int socket, std::uint32_t events, Pollable& pollable) override;
  void change(int socket, std::uint32_t events, Pollable& pollable) override;
  void remove(int socket) override;
  /// Keeps what is no longer watched until no event can name it any more.
  void retire(std::shared_ptr<Pollable> pollable);

  /// Runs `work` soon: on the polling thread or, once the threads have been told to stop, on one
  /// that is made for it. Never in place. May run user code.
  void post(std::function<void()> work) { post({std::move(work), nullptr, nullptr}); }
  /// The same for what takes the threads of a session: it waits while these are too many.
  void post(std::function<void()> work, std::shared_ptr<ThreadShare> share) {
    post({std::move(work), std::move(share), nullptr});
  }
  /// The same for what `pollable` would do in on_ready(): it does not wait for threads, but should
  /// it block, the pollable is told so, and it takes a thread of the pollable's share.
  void post_for(std::shared_ptr<Pollable> pollable, std::function<void()> work) {
    post({std::move(work), nullptr, std::move(pollable)});
  }

  /// What the node counts; null: metrics are off.
  [[nodiscard]] Metrics* metrics() const { return terms_.metrics.get(); }
  [[nodiscard]] const std::shared_ptr<Metrics>& shared_metrics() const { return terms_.metrics; }

  /// Records which accepted connections receive data.
  [[nodiscard]] Readers& readers() { return readers_; }

  /// How many connections there are. No thread of the reactor may wait for their end.
  [[nodiscard]] ConnectionCount& connections() { return connections_; }

  /// Sends what streams leave behind; see Flusher. Stops when this does.
  [[nodiscard]] Flusher& flusher() { return flusher_; }

  /// Makes a timer due at `when`, unless its owner has gone by then; replaces an earlier `when`.
  void schedule(Timer& timer, std::weak_ptr<void> owner, Time when);
  void cancel(Timer& timer);

  /// To be called before a thread waits for something that another thread may have to bring: if it
  /// is a reactor's polling thread, another one polls from now on.
  static void about_to_wait();

  /// A share for a connection from a remote address (remote_key()).
  std::shared_ptr<ThreadShare> open_share(const std::string& key);
  /// How what a connection has brought may be handled on this thread. Takes a lock only where the
  /// answer may be another than `in_place`.
  [[nodiscard]] Handling admission(const std::shared_ptr<ThreadShare>& share) {
    if (share == nullptr) return Handling::in_place;
    const bool is_tight = is_tight_.load(std::memory_order_relaxed);
    return share->is_inconspicuous() && !is_tight ? Handling::in_place : look_up(*share);
  }
  /// Before a handler that is expected to take long: another thread polls from now on, if this one
  /// has until now. Nothing happens when there is none.
  static void give_way();
  /// To be called now and then by work that may be long, under no lock. When it has kept the
  /// polling thread for longest_turn another one polls from now on; and a thread that does not poll
  /// lets others have its processor first, as often.
  static void yield();
  /// True while the calling thread polls: what it does holds up others.
  [[nodiscard]] bool is_polling() const;
  /// From a handler: true when the calling thread polls and somebody waits for it, who is not the
  /// one whose handler this is.
  [[nodiscard]] bool holds_up_others();
  /// What waits for threads of a share is looked at again.
  void reconsider();
  [[nodiscard]] unsigned session_threads() const { return terms_.session_threads; }

  /// On the polling thread, while it handles an event: true when another one polls from now on, and
  /// this one may receive for the event's connection alone, until end_stay(). False when there
  /// were events of others, too, or threads are needed for other things.
  bool begin_stay();
  void end_stay();
  /// True when threads that stay are to come back soon.
  [[nodiscard]] bool is_stay_over() const { return is_stay_over_.load(std::memory_order_relaxed); }
  // For tests: how many threads stay, are held, exist; how much work waits for threads.
  [[nodiscard]] unsigned stays() const;
  [[nodiscard]] unsigned held() const;
  [[nodiscard]] unsigned live_threads() const;
  [[nodiscard]] std::size_t waiting() const;

 private:
  struct Polling;  // what a thread knows while it polls
  // Constants at first, so that other files reach them without a call.
  static constinit thread_local Polling* current_polling;
  static constinit thread_local const Reactor* current_reactor;

  struct Posted {
    std::function<void()> work;
    std::shared_ptr<ThreadShare> share;  // whose threads it takes, and waits for
    std::shared_ptr<Pollable> pollable;  // whose handler it is
  };

  void post(Posted posted);
  void run_thread();
  void poll_until_lost() RR_REQUIRES(mutex_);
  void poll(Polling& polling);
  bool watch() RR_REQUIRES(mutex_);
  bool take_over(std::uint64_t turn) RR_REQUIRES(mutex_);
  bool hand_over(Polling& polling, bool is_held) RR_REQUIRES(mutex_);
  void note_loss(Polling& polling) RR_REQUIRES(mutex_);
  RetiredPollables::Pollables take_retired();
  void hold(Polling& polling) RR_REQUIRES(mutex_);
  void release(Polling& polling) RR_REQUIRES(mutex_);
  [[nodiscard]] Handling look_up(const ThreadShare& share);
  [[nodiscard]] Handling admit(const ThreadShare& share) const RR_REQUIRES(mutex_);
  void move_waiting() RR_REQUIRES(mutex_);
  void note_free() RR_REQUIRES(mutex_);
  [[nodiscard]] unsigned free_threads() const RR_REQUIRES(mutex_);
  void enter(Polling& polling, Pollable* pollable);
  bool leave(Polling& polling);
  [[nodiscard]] bool is_inside(const Polling& polling) const;
  bool handle_events(Polling& polling);
  [[nodiscard]] bool find_others(const Pollable* own);
  [[nodiscard]] bool is_posted_for_others(const Pollable* own) const;
  bool run_posted(Polling& polling);
  static void yield_processor(Time& at);
  bool next_posted(Posted& next, Handling& admission);
  void run(const std::function<void()>& work) const;
  bool add_thread() RR_REQUIRES(mutex_);
  bool secure_thread() RR_REQUIRES(mutex_);
  void call_back_stays() RR_REQUIRES(mutex_);
  void report_missing_thread() RR_REQUIRES(mutex_);
  void reap() RR_REQUIRES(mutex_);
  void wake_watching_thread();
  void wake_polling_thread();
  Time run_timers() RR_REQUIRES(mutex_);

  const Terms terms_;
  const unsigned max_threads_;
  const unsigned max_stays_;
  const unsigned reserve_;  // threads for sessions that hold none
  Flusher flusher_;
  Readers readers_;
  platform::Poller sockets_;

  PollingTurn<> turn_;
  std::atomic<bool> has_work_{false};  // posted or retired

  // Of the thread whose turn it is; handed over with turn_.
  ReadyEvents events_;
  Pollable* handling_ = nullptr;

  mutable Mutex mutex_;
  Condition idle_;
  Condition watch_;
  std::atomic<bool> is_stopping_{false};  // written under mutex_
  bool is_polled_ RR_GUARDED_BY(mutex_) = false;
  bool is_watched_ RR_GUARDED_BY(mutex_) = false;
  Polling* poller_ RR_GUARDED_BY(mutex_) = nullptr;  // of the thread whose turn it is
  unsigned held_ RR_GUARDED_BY(mutex_) =
      0;                               // threads that do not poll any more and are in a handler
  std::atomic<bool> is_tight_{false};  // hardly any thread is left; written under mutex_
  Time no_thread_until_ RR_GUARDED_BY(mutex_) = Time::min();  // none could be made a moment ago
  bool must_report_ RR_GUARDED_BY(mutex_) = false;            // and nobody has been told
  AddressTable addresses_ RR_GUARDED_BY(mutex_);
  unsigned idle_threads_ RR_GUARDED_BY(mutex_) = 0;
  unsigned wanted_threads_ RR_GUARDED_BY(mutex_) = 0;  // idle ones that have been woken
  unsigned live_threads_ RR_GUARDED_BY(mutex_) = 0;
  unsigned stays_ RR_GUARDED_BY(mutex_) = 0;
  std::atomic<bool> is_stay_over_{false};  // written under mutex_
  std::list<std::thread> threads_ RR_GUARDED_BY(mutex_);
  std::vector<std::thread::id> ended_ RR_GUARDED_BY(mutex_);
  TimerHeap timers_ RR_GUARDED_BY(mutex_);
  std::deque<Posted> posted_ RR_GUARDED_BY(mutex_);
  std::deque<Posted> waiting_ RR_GUARDED_BY(mutex_);  // for threads of their shares
  RetiredPollables retired_ RR_GUARDED_BY(mutex_);
  ConnectionCount connections_;
  LateWork late_;  // what is posted from is_stopping_ on
};

}  // namespace rr::channel
