// SPDX-License-Identifier: Apache-2.0
// The dispatch turn of a connection while the thread that had it waits inside of the receiver, and
// messages that are handled without it.
#include "runtime/cpp/src/channel/dispatch_turn.hpp"

#include <mutex>
#include <utility>

#include "runtime/cpp/src/channel/remote_address.hpp"

namespace rr::channel {
namespace {

// Of a client: functions of callbacks that run at once. Each of them keeps a thread; what comes on
// top of that waits for the turn, in the queue whose limit stops the other side.
constexpr unsigned most_absent = 16;

}  // namespace

// Under turns_. Of a service these are the members that wait, without the one that runs.
bool StreamConnection::may_be_absent() const {
  if (threads_ == nullptr) return absent_ < most_absent;
  return absent_ + 1 < reactor_->session_threads();
}

thread_local StreamConnection::Turn* StreamConnection::current_turn = nullptr;

StreamConnection::Turn::Turn(StreamConnection& connection, Scratch& scratch)
    : connection_(connection), scratch_(scratch), outer_(std::exchange(current_turn, this)) {}

StreamConnection::Turn::~Turn() { current_turn = outer_; }

StreamConnection::Turn* StreamConnection::Turn::current(const StreamConnection& connection) {
  return current_turn != nullptr && &current_turn->connection_ == &connection ? current_turn
                                                                              : nullptr;
}

bool StreamConnection::give_up_turn() {
  Turn* const turn = Turn::current(*this);
  if (turn == nullptr || !turn->is_held()) return false;
  bool must_post = false;
  bool must_flush = false;
  {
    const std::lock_guard lock(turns_);
    if (!may_be_absent()) return false;
    ++absent_;
    turn->set_held(false);
    must_flush = std::exchange(holds_back_answers_, false);
    put_back(*turn);
    must_post = is_stalled_ || (queue_ && !queue_->empty());
    if (must_post || returning_ != nullptr) {
      loosen_turn();
    } else {
      is_dispatched_ = false;
    }
  }
  if (must_flush) flush();
  if (must_post) drain_soon();
  return true;
}

// Under turns_: what the thread has not handled is next again.
void StreamConnection::put_back(Turn& turn) {
  while (turn.has_next()) {
    if (!queue_) queue_ = std::make_unique<std::deque<Frame>>();
    queue_->push_front(keep(turn.take_last()));
    queued_bytes_ += queue_->front().bytes.size();
    charge(queue_->front());
  }
  is_stalled_ = is_stalled_ || queued_bytes_ > options_->request_queue_limit;
}

bool StreamConnection::put_off() {
  Turn* const turn = Turn::current(*this);
  if (turn == nullptr || !turn->is_held() || turn->is_put_off()) return false;
  turn->set_put_off(true);
  const std::lock_guard lock(turns_);
  put_off_ = PutOff::begun;
  return true;
}

// After the handler has returned. False when it may be called again at once, by this thread.
bool StreamConnection::is_suspended(Turn& turn, Frame frame) {
  turn.set_put_off(false);
  holds_back_answers_ = false;
  const std::lock_guard lock(turns_);
  put_back(turn);
  if (!queue_) queue_ = std::make_unique<std::deque<Frame>>();
  queue_->push_front(keep(std::move(frame)));
  queued_bytes_ += queue_->front().bytes.size();
  charge(queue_->front());
  turn.scratch().waiting.clear();
  if (put_off_ == PutOff::resumed) {
    put_off_ = PutOff::no;
    return false;
  }
  put_off_ = PutOff::suspended;
  return true;
}

void StreamConnection::resume() {
  {
    const std::lock_guard lock(turns_);
    if (put_off_ == PutOff::begun) {
      put_off_ = PutOff::resumed;
      return;
    }
    if (std::exchange(put_off_, PutOff::no) != PutOff::suspended) return;
    loosen_turn();
  }
  drain_soon();
}

bool StreamConnection::take_turn_again(Time deadline) {
  Reactor::about_to_wait();
  Returning self;
  std::unique_lock lock(turns_);
  Returning** link = &returning_;
  while (*link != nullptr) link = &(*link)->next;
  *link = &self;
  // Posted work may come too late, as when the node is shut down: then this thread is faster.
  while (is_dispatched_ && !is_turn_loose_ && Clock::now() < deadline) {
    wait_until(self.wake, lock, deadline);
  }
  for (link = &returning_; *link != &self;) link = &(*link)->next;
  *link = self.next;
  if (is_dispatched_ && !is_turn_loose_) return false;
  is_dispatched_ = true;
  const bool must_read = fasten_turn();
  --absent_;
  Turn::current(*this)->set_held(true);
  lock.unlock();
  if (must_read) read_soon(false);
  return true;
}

void StreamConnection::await_turn() {
  const Turn* const turn = Turn::current(*this);
  if (turn != nullptr && !turn->is_held()) take_turn_again(never);
}

// Under turns_: nobody dispatches now, but somebody has to.
void StreamConnection::loosen_turn() {
  is_dispatched_ = true;
  is_turn_loose_ = true;
  if (returning_ != nullptr) returning_->wake.notify_one();
}

bool StreamConnection::begin_absence() {
  const std::lock_guard lock(turns_);
  if (!may_be_absent()) return false;
  ++absent_;
  return true;
}

// The last one owes the end of the connection.
void StreamConnection::end_absence() {
  {
    const std::lock_guard lock(turns_);
    --absent_;
    if (absent_ != 0 || !is_closed_pending_ || is_dispatched_) return;
    loosen_turn();
  }
  drain_soon();
}

// The threads that the functions of callbacks take: several services together leave some to others.
// Those of an address do not count as its clients.
std::shared_ptr<ThreadShare> StreamConnection::callback_share() {
  const std::lock_guard lock(turns_);
  if (!callback_threads_)
    callback_threads_ = reactor_->open_share("to " + remote_key(remote_address_));
  return callback_threads_;
}

// After begin_absence().
void StreamConnection::handle_aside(Frame frame) {
  auto kept = std::make_shared<const Frame>(keep(std::move(frame)));
  std::shared_ptr<ThreadShare> share = callback_share();
  auto work = [self = shared_from_this(), kept = std::move(kept), share] {
    const Time begin = coarse_now();
    {
      const ScratchLease scratch;
      self->handle_frame(*scratch, *kept, false, nullptr);
    }
    share->ran(coarse_now() != begin);
    self->end_absence();
  };
  reactor_->post(std::move(work), std::move(share));
}

}  // namespace rr::channel
