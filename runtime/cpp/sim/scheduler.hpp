// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <pthread.h>

#include <cstdint>
#include <deque>
#include <functional>
#include <memory>
#include <queue>
#include <string>
#include <vector>

#include "runtime/cpp/sim/context.hpp"
#include "runtime/cpp/sim/random.hpp"
#include "runtime/cpp/sim/trace.hpp"

namespace rr::sim {

/// Nanoseconds since a run began.
using Nanoseconds = std::int64_t;
constexpr Nanoseconds never = INT64_MAX;

/// How threads take turns. Drawn from the seed.
struct Turns {
  /// At a scheduling point another thread is chosen once in so many times; 0: only at waits.
  std::uint64_t switches_once_in = 0;
  /// Threads have ranks and the highest runs; a rank falls at random points.
  bool has_ranks = false;
  /// A thread is held up at a scheduling point once in so many times; 0: never.
  std::uint64_t stalls_once_in = 0;
  /// So often in a run.
  std::uint64_t most_stalls = 20;
  /// The longest that it is held up.
  Nanoseconds longest_stall = 0;
};

/// Runs the threads of this process one at a time, on a clock of its own, in an order that follows
/// from a seed. Each has a thread of the system, since thread-local objects must be its own, and
/// waits until it is given the turn (Context). What may block goes through wait(), what others may
/// see through point(). All members are called by the thread whose turn it is.
class Scheduler {
 public:
  /// One simulated thread.
  struct Thread {
    int number = 0;
    pthread_t system{};
    Context context;
    const char* waits_for = nullptr;  ///< a literal; null: can run
    const void* object = nullptr;     ///< what it waits for
    Nanoseconds deadline = never;
    bool is_timed_out = false;
    bool has_ended = false;
    const void* caller = nullptr;  ///< where it waits
    std::uint64_t rank = 0;
    std::vector<const void*> held;  ///< mutexes
    void* (*start)(void*) = nullptr;
    void* argument = nullptr;
  };

  /// Begins a run in the calling thread, which becomes thread 0.
  Scheduler(std::uint64_t seed, const Turns& turns);
  ~Scheduler();
  Scheduler(const Scheduler&) = delete;
  Scheduler& operator=(const Scheduler&) = delete;

  /// The run to which the calling thread belongs; null for none.
  static Scheduler* current();
  /// The calling thread.
  static Thread& self();

  [[nodiscard]] Nanoseconds now() const { return now_; }
  /// How long threads may be held up in all.
  [[nodiscard]] Nanoseconds longest_delay() const {
    return turns_.stalls_once_in == 0
               ? 0
               : static_cast<Nanoseconds>(turns_.most_stalls) * turns_.longest_stall;
  }
  Random& random() { return random_; }
  Trace& trace() { return trace_; }

  /// A step that others may see: another thread may be given the turn.
  void point(const char* what, const void* object, std::int64_t amount, const void* caller);
  /// Reading the clock takes time too, so that a loop over it ends.
  Nanoseconds read_clock();
  /// Waits until wake() of the object, or the deadline: false then.
  bool wait(const char* what, const void* object, Nanoseconds deadline, const void* caller);
  /// Lets threads go on that wait for an object: `most` of them, any.
  int wake(const void* object, int most);
  /// Gives the turn to another thread that can run, if there is one.
  void yield();
  /// Runs `work` at a time, in whichever thread has the turn then. It must not wait.
  void at(Nanoseconds time, std::function<void()> work);

  /// pthread_create of a simulated thread; its result.
  int start(pthread_t* system, const pthread_attr_t* attributes, void* (*function)(void*),
            void* argument);
  /// Waits until a thread has ended. False for one that is none of this run.
  bool join(pthread_t system, const void* caller);
  /// Threads of the run that have not ended, the calling one included.
  [[nodiscard]] std::size_t alive() const;

  /// Remembers what happens in the scenario, for the report.
  void note(std::string text);
  /// Ends the process: something is wrong. Prints why, what each thread does, and the last steps.
  [[noreturn]] void fail(const std::string& why);
  /// The threads and where they wait, a line each.
  [[nodiscard]] std::string threads_text() const;

 private:
  struct Note {
    Nanoseconds time;
    int thread;
    std::string text;
  };
  struct Event {
    Nanoseconds time;
    std::uint64_t number;
    std::function<void()> work;
    bool operator>(const Event& other) const {
      return time != other.time ? time > other.time : number > other.number;
    }
  };

  static pthread_key_t make_end_key();
  static void* run(void* thread);
  static void leave(void* thread);
  void leave_run();
  void pass_time(Nanoseconds time);
  void run_due();
  Thread* choose();
  void hand_over(Thread& next);
  Thread& next_that_can_run();
  void make_ready(Thread& thread);

  const pthread_key_t end_key_;
  Random random_;
  const Turns turns_;
  Trace trace_;
  std::deque<Note> notes_;
  Nanoseconds now_ = 0;
  Nanoseconds next_due_ = never;  // the earliest of events and deadlines, or before it
  std::uint64_t events_made_ = 0;
  std::uint64_t clock_reads_ = 0;
  std::uint64_t stalls_ = 0;
  std::priority_queue<Event, std::vector<Event>, std::greater<>> events_;
  std::vector<std::unique_ptr<Thread>> threads_;
  const Thread* last_ = nullptr;  // that has left the run
  std::vector<Thread*> ready_;    // can run, the running one included
  std::vector<Thread*> waiting_;  // in the order in which they began to wait
};

}  // namespace rr::sim
