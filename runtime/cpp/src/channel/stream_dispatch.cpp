// SPDX-License-Identifier: Apache-2.0
// How messages reach the receiver: the strand of a connection, and what is handled beside it.
#include <utility>

#include "runtime/cpp/src/channel/remote_address.hpp"
#include "runtime/cpp/src/channel/strand_turn.hpp"
#include "runtime/cpp/src/channel/stream_connection.hpp"
#include "runtime/cpp/src/codec/parse.hpp"

namespace rr::channel {
namespace {

// Of a client: functions of callbacks that run at once. Each of them keeps a thread; what comes on
// top of that waits for the strand, in the queue whose limit stops the other side.
constexpr unsigned most_outside = 16;

}  // namespace

// Functions of the program, as messages are handled: here where that holds up nobody.
void StreamConnection::run_deferred(DeferredCallbacks& deferred, Handling admission) {
  for (std::size_t i = 0; i < deferred.size(); ++i) {
    std::function<void()> later = std::move(deferred[i]);
    if (admission == Handling::in_place) {
      later();
    } else {
      reactor_->post(std::move(later), threads_);
    }
  }
  deferred.clear();
}

// With the strand, which is given back.
void StreamConnection::handle_in_turn(StrandTurn& turn, Handling admission, bool& is_again) {
  if (admission == Handling::aside) Reactor::give_way();
  if (!dispatch(turn)) return;
  is_again = drain(turn) || is_again;
  if (threads_) note_pace(turn);
}

// Whether what was handled in the turn was slow. A thread that has waited for something else
// meanwhile does not poll any more, and has blocked nobody.
[[gnu::hot]] void StreamConnection::note_pace(const StrandTurn& turn) {
  const bool is_slow = turn.is_slow();
  if (is_slow && !threads_->is_slow() && !reactor_->is_polling()) return;
  threads_->ran(is_slow);
}

// Messages are handled by this thread if it may and nobody else does; then true.
// Otherwise they join the queue, and somebody is made to handle it.
[[gnu::hot]] bool StreamConnection::hand_on(Scratch& scratch, bool may_dispatch, bool& must_post) {
  if (scratch.waiting.empty()) return false;
  if (may_dispatch && strand_.enter()) return true;
  for (Frame& frame : scratch.waiting) strand_.push(std::move(frame));
  scratch.waiting.clear();
  must_post = !strand_.is_taken();
  if (must_post) strand_.orphan();
  strand_.check_limit();
  end_if_lost();
  return false;
}

// Under mutex_: a message that could not be kept is the last.
void StreamConnection::end_if_lost() {
  if (strand_.has_lost()) begin_close(no_memory());
}

// A thread that polls does not handle the messages of one connection for long while others wait.
bool StreamConnection::must_yield(StrandTurn& turn) const {
  if (!turn.is_over()) return false;
  if (reactor_->holds_up_others()) return true;
  turn.go_on();
  return false;
}

// With the strand: the messages in the scratch. False when the handler of one has suspended it.
[[gnu::hot]] bool StreamConnection::dispatch(StrandTurn& turn) {
  Scratch& scratch = turn.scratch();
  const std::size_t parsed = scratch.parsed;
  const std::size_t count = scratch.waiting.size();
  // The last one is usually the only one, and still parsed.
  while (turn.has_next() && !is_departed()) {
    if (answers_wait() || (count > 1 && must_yield(turn))) {
      queue_rest(turn);
      break;
    }
    if (turn.has_gone_on()) flush();  // others do not wait, but who has asked does
    Frame frame = turn.next();
    holds_back_answers_ = turn.has_next();
    handle_frame(scratch, frame, count == 1 && parsed == 1, &turn);
    if (turn.is_put_off() && is_suspended(turn, std::move(frame))) {
      if (count > 1) flush();
      return false;
    }
  }
  scratch.waiting.clear();
  if (count > 1) flush();
  return true;
}

// With the strand: what the thread has not handled of a receive is next again.
void StreamConnection::queue_rest(StrandTurn& turn) {
  holds_back_answers_ = false;
  const MutexLock lock(mutex_);
  strand_.push_rest(turn);
  end_if_lost();
}

// With the strand, which is given back: the queue. True when reading had to stop because of it.
// Whoever has stepped out and wants to step in again comes first.
[[gnu::hot]] bool StreamConnection::drain(StrandTurn& turn) {
  MutexLock lock(mutex_);
  bool is_looked_at = false;
  while (true) {
    if (strand_.is_anybody_returning()) {
      strand_.orphan();
      return false;
    }
    if (strand_.has_queued() && is_departed()) {
      auto dropped = strand_.take_queue();
      lock.unlock();
      dropped.reset();
      lock.lock();
    } else if (strand_.has_queued()) {
      if (sending_.has_many_answers() && !std::exchange(is_looked_at, true)) {
        lock.unlock();
        answers_wait();
        lock.lock();
        continue;
      }
      if (sending_.do_answers_wait()) {  // go_on() comes
        strand_.leave();
        return false;
      }
      is_looked_at = false;
      if (must_yield(turn)) {
        strand_.orphan();
        lock.unlock();
        drain_soon();
        return false;
      }
      Frame frame = strand_.pop();
      lock.unlock();
      handle_frame(turn.scratch(), frame, false, &turn);
      if (turn.is_put_off() && is_suspended(turn, std::move(frame))) return false;
      lock.lock();
    } else if (strand_.take_end()) {
      lock.unlock();
      receiver_->closed();
      receiver_.reset();
      reactor_->connections().end();
      lock.lock();
    } else {
      break;
    }
  }
  const bool was_full = strand_.finish();
  if (was_full) message_deadline_.restart();
  return was_full;
}

void StreamConnection::drain_soon() {
  reactor_->post([self = shared_from_this()] { self->drain_posted(); }, threads_);
}

// As posted work: the queue, filled by a caller that read, or while there was no thread for it.
void StreamConnection::drain_posted() {
  bool was_stalled = false;
  {
    bool must_read = false;
    {
      const MutexLock lock(mutex_);
      if (!strand_.adopt()) return;  // somebody was faster
      must_read = must_read_on();
    }
    if (must_read) read_soon(false);
    const ScratchLease scratch;
    scratch->waiting.clear();
    StrandTurn turn(strand(), *scratch, longest_turn_here());
    was_stalled = drain(turn);
    if (threads_) note_pace(turn);
  }
  if (was_stalled && take_read_lease()) read_as_reactor(true);
}

// `turn`: the thread's, or null.
[[gnu::hot]] void StreamConnection::handle_frame(Scratch& scratch, const Frame& frame,
                                                 bool is_parsed, StrandTurn* turn) {
  Message& message = scratch.message;
  if (!is_parsed &&
      !codec::reread_message(frame.bytes, has_standard_strings_, message, scratch.first)) {
    return;
  }
  complete(message);
  if (turn != nullptr) turn->count(message.entry_count);
  try {
    receiver_->handle(message, scratch.first, frame.owner);
  } catch (const std::exception& error) {  // not of the program's code, which is looked after
    close(no_memory(error.what()));
  }
  // What could not be sent is not to be kept until this thread writes again.
  Writer& writer = thread_writer();
  if (writer.size() >= Writer::attach_threshold) writer.reset(writer.version());
  if (turn != nullptr && !turn->is_held()) step_in(never);
}

// What a message of format 4 leaves out is known from the connection (02, section 7).
void StreamConnection::complete(Message& message) const {
  if (!message.has_routing) {
    message.sender_node = remote_node_;
    message.receiver_node = options_->id;
  }
  if (layers_.is_proven()) message.sender_node = layers_.sender_of(message);
  if (!message.has_endpoints) {
    message.sender_endpoint = remote_endpoint_.load(std::memory_order_relaxed);
    message.receiver_endpoint = own_endpoint_.load(std::memory_order_relaxed);
  }
}

// What a client receives at once is handled in four times the time: it need not be copied to wait.
std::chrono::microseconds StreamConnection::longest_turn_here() const {
  return role_ == Role::client ? 4 * longest_turn : longest_turn;
}

// Waiting inside a handler

// Of a service these are the members that wait, without the one that runs.
bool StreamConnection::may_go_outside() const {
  if (threads_ == nullptr) return strand_.outside() < most_outside;
  return strand_.outside() + 1 < reactor_->session_threads();
}

bool StreamConnection::step_out() {
  StrandTurn* const turn = StrandTurn::current(strand());
  if (turn == nullptr || !turn->is_held()) return false;
  bool must_post = false;
  bool must_flush = false;
  {
    const MutexLock lock(mutex_);
    if (!may_go_outside()) return false;
    must_flush = std::exchange(holds_back_answers_, false);
    must_post = strand_.step_out(*turn);
    end_if_lost();
  }
  if (must_flush) flush();
  if (must_post) drain_soon();
  return true;
}

bool StreamConnection::step_in(Time deadline) {
  Reactor::about_to_wait();
  bool must_read = false;
  {
    const MutexLock lock(mutex_);
    if (!strand_.step_in(*StrandTurn::current(strand()), mutex_, deadline)) return false;
    must_read = must_read_on();
  }
  if (must_read) read_soon(false);
  return true;
}

void StreamConnection::await_strand() {
  const StrandTurn* const turn = StrandTurn::current(strand());
  if (turn != nullptr && !turn->is_held()) step_in(never);
}

// A thread has the strand of a client, which did not read while nobody had it.
bool StreamConnection::must_read_on() {
  return role_ == Role::client && !lease_.is_taken() && lease_.is_asked_again();
}

bool StreamConnection::suspend() {
  StrandTurn* const turn = StrandTurn::current(strand());
  if (turn == nullptr || !turn->is_held() || turn->is_put_off()) return false;
  turn->set_put_off(true);
  const MutexLock lock(mutex_);
  strand_.begin_suspending();
  return true;
}

// After the handler has returned. False when it may be called again at once, by this thread.
bool StreamConnection::is_suspended(StrandTurn& turn, Frame frame) {
  turn.set_put_off(false);
  holds_back_answers_ = false;
  const MutexLock lock(mutex_);
  const bool is_suspended = strand_.suspend(turn, std::move(frame));
  end_if_lost();
  return is_suspended;
}

void StreamConnection::resume() {
  {
    const MutexLock lock(mutex_);
    if (!strand_.resume()) return;
  }
  drain_soon();
}

// Beside the strand

bool StreamConnection::begin_beside() {
  const MutexLock lock(mutex_);
  if (!may_go_outside()) return false;
  strand_.go_beside();
  return true;
}

// The last one owes the end of the connection.
void StreamConnection::end_beside() {
  {
    const MutexLock lock(mutex_);
    strand_.come_from_beside();
    if (!strand_.is_end_due() || strand_.is_taken()) return;
    strand_.orphan();
  }
  drain_soon();
}

// The threads that the functions of callbacks take: several services together leave some to others.
// Those of an address do not count as its clients.
std::shared_ptr<ThreadShare> StreamConnection::callback_share() {
  const MutexLock lock(mutex_);
  if (!callback_threads_) {
    callback_threads_ = reactor_->open_share("to " + remote_key(remote_address_));
  }
  return callback_threads_;
}

// After begin_beside().
void StreamConnection::handle_beside(Frame frame) {
  auto kept = std::make_shared<const Frame>(Strand::keep(std::move(frame)));
  std::shared_ptr<ThreadShare> share = callback_share();
  auto work = [self = shared_from_this(), kept = std::move(kept), share] {
    const Time begin = coarse_now();
    {
      const ScratchLease scratch;
      self->handle_frame(*scratch, *kept, false, nullptr);
    }
    share->ran(coarse_now() != begin);
    self->end_beside();
  };
  reactor_->post(std::move(work), std::move(share));
}

}  // namespace rr::channel
