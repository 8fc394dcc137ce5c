// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <array>
#include <cstdint>
#include <span>
#include <utility>

#include "rr/mutex.hpp"
#include "runtime/cpp/src/channel/synchronization.hpp"
#include "runtime/cpp/src/channel/time.hpp"
#include "runtime/cpp/src/channel/transition.hpp"

namespace rr::channel {

/// The thread that hands on messages.
enum class StrandPhase : std::uint8_t {
  free,       ///< none, and nothing is queued, unless answers have to leave first
  held,       ///< a thread
  orphaned,   ///< a thread that is on its way: posted work, or one that steps in again
  suspended,  ///< none until resume()
};

/// Which thread hands on the messages of a strand; without them. See Strand. All of it under the
/// connection's lock.
template <class Sync = Synchronization>
class StrandState {
 public:
  using State = StrandPhase;

  /// All changes of the state.
  static std::span<const Transition<State>> transitions() {
    using enum StrandPhase;
    static constexpr std::array<Transition<State>, 8> rows = {{
        {free, "enter", held},
        {free, "orphan", orphaned},
        {free, "step_in", held},
        {held, "finish, leave, step_out", free},
        {held, "orphan, step_out", orphaned},
        {held, "suspend", suspended},
        {orphaned, "adopt, step_in", held},
        {suspended, "resume", orphaned},
    }};
    return rows;
  }

  [[nodiscard]] State get() const { return state_; }
  [[nodiscard]] bool is_taken() const { return state_ != State::free; }

  /// The calling thread has it now. False when it was not free.
  bool enter();
  /// Another thread has to go on; the thread that has waited longest in step_in() is woken.
  void orphan();
  /// The calling thread goes on. False when another one was faster.
  bool adopt();
  void set_free() { become(State::free); }

  /// Threads in the receiver, now or soon, without the strand.
  [[nodiscard]] unsigned outside() const { return outside_; }
  void go_outside() { ++outside_; }
  void come_inside() { --outside_; }
  /// The calling thread, which is outside, has the strand no longer. `must_go_on`: others have to
  /// have it.
  void give_up(bool must_go_on);
  /// Waits until the calling thread has it again, and is not outside any more. False at the
  /// deadline.
  bool step_in(typename Sync::Mutex& mutex, Time deadline) RR_REQUIRES(mutex);
  [[nodiscard]] bool is_anybody_returning() const { return returning_ != nullptr; }

  void begin_suspending() { suspension_ = Suspension::begun; }
  /// False when it has been resumed already.
  bool suspend();
  /// True when the caller has to make another thread go on.
  bool resume();

 private:
  enum class Suspension : std::uint8_t { no, begun, resumed };
  template <class T>
  using Plain = typename Sync::template Plain<T>;
  struct Returning;
  using Link = Plain<Returning*>;
  /// A thread that wants the strand back, on its stack.
  struct Returning {
    typename Sync::Condition wake;
    Link next = nullptr;
  };

  void become(State state) {
    State now = state_;
    change(now, state, transitions());
    state_ = now;
  }
  [[nodiscard]] bool is_elsewhere() const {
    return state_ == State::held || state_ == State::suspended;
  }

  Plain<State> state_ = State::free;
  Plain<Suspension> suspension_ = Suspension::no;
  Plain<unsigned> outside_ = 0U;
  Link returning_ = nullptr;
};

template <class Sync>
bool StrandState<Sync>::enter() {
  if (is_taken()) return false;
  become(State::held);
  return true;
}

template <class Sync>
void StrandState<Sync>::orphan() {
  become(State::orphaned);
  if (returning_ != nullptr) returning_->wake.notify_one();
}

template <class Sync>
bool StrandState<Sync>::adopt() {
  if (state_ != State::orphaned) return false;
  become(State::held);
  return true;
}

template <class Sync>
void StrandState<Sync>::give_up(bool must_go_on) {
  if (must_go_on || returning_ != nullptr) {
    orphan();
  } else {
    become(State::free);
  }
}

template <class Sync>
bool StrandState<Sync>::step_in(typename Sync::Mutex& mutex, Time deadline) {
  Returning self;
  Link* link = &returning_;
  while (*link != nullptr) link = &(*link)->next;
  *link = &self;
  // Posted work may come too late, as when the node is shut down: then this thread is faster.
  while (is_elsewhere() && Sync::now() < deadline) Sync::wait_until(self.wake, mutex, deadline);
  for (link = &returning_; *link != &self;) link = &(*link)->next;
  *link = self.next;
  if (is_elsewhere()) return false;
  become(State::held);
  --outside_;
  return true;
}

template <class Sync>
bool StrandState<Sync>::suspend() {
  if (std::exchange(suspension_, Suspension::no) == Suspension::resumed) return false;
  become(State::suspended);
  return true;
}

template <class Sync>
bool StrandState<Sync>::resume() {
  if (suspension_ == Suspension::begun) {
    suspension_ = Suspension::resumed;
    return false;
  }
  if (state_ != State::suspended) return false;
  orphan();
  return true;
}

}  // namespace rr::channel
