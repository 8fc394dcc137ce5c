// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <cstddef>
#include <cstdint>
#include <deque>
#include <memory>
#include <span>
#include <utility>

#include "rr/mutex.hpp"
#include "runtime/cpp/src/channel/account.hpp"
#include "runtime/cpp/src/channel/scratch.hpp"
#include "runtime/cpp/src/channel/strand_state.hpp"
#include "runtime/cpp/src/channel/time.hpp"
#include "runtime/cpp/src/channel/transition.hpp"

namespace rr::channel {

class StrandTurn;

/// Serial execution of the messages of one connection: one thread at a time hands them to the
/// receiver, in order of arrival. Messages that arrive meanwhile are queued and charged to their
/// sender.
///
/// A handler that waits for something which a later message may have to bring steps out of the
/// strand for as long: another thread goes on with the queue. It steps in again before its handler
/// goes on. A handler may also suspend the strand: its message is handled once more later.
///
/// All of it under the connection's lock.
class Strand {
 public:
  using State = StrandPhase;

  /// All changes of the state. A test compares them with the table in docs/architecture.md.
  static std::span<const Transition<State>> transitions() { return StrandState<>::transitions(); }

  /// `limit`: bytes that may be queued before the connection is not read on. `account`: of who is
  /// charged for what is queued, null for nobody; it outlives this, and changes before it is used.
  Strand(std::size_t limit, const std::shared_ptr<Account>& account)
      : limit_(limit), account_(account) {}
  Strand(const Strand&) = delete;
  Strand& operator=(const Strand&) = delete;

  [[nodiscard]] State state() const { return state_.get(); }
  [[nodiscard]] bool is_taken() const { return state_.is_taken(); }
  [[nodiscard]] bool is_orphaned() const { return state() == State::orphaned; }

  /// The free strand with an empty queue goes to the calling thread. False when it is not that.
  bool enter() { return !queue_ && state_.enter(); }
  /// Somebody has to go on with it who does not have it yet: a thread that waits in step_in() is
  /// woken; if there is none, the caller posts work that calls adopt().
  void orphan() { state_.orphan(); }
  /// The calling thread goes on with the strand. False when another one was faster.
  bool adopt() { return state_.adopt(); }
  /// Nobody hands on messages, though some may be queued: they wait for what calls orphan().
  void leave() { state_.set_free(); }
  /// The queue is empty: the strand is free. True when the connection had to stop reading because
  /// of what was queued.
  bool finish();

  // The queue. What cannot be kept for want of memory is lost: has_lost() is true from then on, and
  // the connection must end.
  void push(Frame frame);
  /// The next one is this, again.
  void push_first(Frame frame);
  /// What the thread of the turn has not handled is next again.
  void push_rest(StrandTurn& turn);
  [[nodiscard]] bool has_lost() const { return has_lost_; }
  [[nodiscard]] bool has_queued() const { return queue_ && !queue_->empty(); }
  Frame pop();
  [[nodiscard]] std::unique_ptr<std::deque<Frame>> take_queue();
  /// So much is queued, or the account of the sender is so full, that no more is to be read.
  [[nodiscard]] bool is_full() const { return is_full_; }
  /// Called when a receive has been queued: looks whether the queue is too long now.
  void check_limit() { is_full_ = is_full_ || queued_bytes_ > limit_; }

  // Waiting inside a handler.
  [[nodiscard]] unsigned outside() const { return state_.outside(); }
  /// The thread of the turn waits outside; what it has not handled is queued first. True when
  /// somebody has to be made to go on.
  bool step_out(StrandTurn& turn);
  /// Waits until the calling thread hands on messages again. False at the deadline: it is still
  /// outside. `mutex`: the connection's.
  bool step_in(StrandTurn& turn, Mutex& mutex, Time deadline) RR_REQUIRES(mutex);
  [[nodiscard]] bool is_anybody_returning() const { return state_.is_anybody_returning(); }
  /// A thread handles a message beside the strand.
  void go_beside() { state_.go_outside(); }
  void come_from_beside() { state_.come_inside(); }

  // Suspending.
  /// From a handler: its message is to be handled again after resume().
  void begin_suspending() { state_.begin_suspending(); }
  /// After that handler: the message is queued first. False when it may be handled at once.
  bool suspend(StrandTurn& turn, Frame frame);
  /// True when the caller has to make somebody go on.
  bool resume() { return state_.resume(); }

  // The end of the connection, which the receiver is notified of after its last message.
  void owe_end() { owes_end_ = true; }
  [[nodiscard]] bool is_end_due() const { return owes_end_ && outside() == 0; }
  [[nodiscard]] bool take_end() { return outside() == 0 && std::exchange(owes_end_, false); }

  /// The frame with bytes that stay.
  [[nodiscard]] static Frame keep(Frame frame);

 private:
  std::deque<Frame>& queue();
  bool put(Frame frame, bool is_first);
  void charge(Frame& frame);

  const std::size_t limit_;
  const std::shared_ptr<Account>& account_;
  StrandState<> state_;
  bool is_full_ = false;
  bool owes_end_ = false;
  bool has_lost_ = false;
  std::unique_ptr<std::deque<Frame>> queue_;
  std::size_t queued_bytes_ = 0;
};

}  // namespace rr::channel
