// SPDX-License-Identifier: Apache-2.0
// The dispatch turn of a connection while the thread that had it waits inside of the receiver, and
// messages that are handled without it.
#include "runtime/cpp/src/channel/dispatch_turn.hpp"

#include <mutex>

namespace rr::channel {
namespace {

// Each of them keeps a thread; what comes on top of that waits for the turn, in the queue whose
// limit stops the other side.
constexpr unsigned most_absent = 16;

}  // namespace

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
    if (absent_ == most_absent) return false;
    ++absent_;
    turn->set_held(false);
    must_flush = std::exchange(holds_back_answers_, false);
    while (turn->has_next()) {
      if (!queue_) queue_ = std::make_unique<std::deque<Frame>>();
      queue_->push_front(keep(turn->take_last()));
      queued_bytes_ += queue_->front().bytes.size();
    }
    must_post = is_stalled_ || (queue_ && !queue_->empty());
    if (must_post || returning_ != nullptr) {
      loosen_turn();
    } else {
      is_dispatched_ = false;
    }
  }
  if (must_flush) flush();
  if (must_post) reactor_->post([self = shared_from_this()] { self->drain_posted(); });
  return true;
}

void StreamConnection::take_turn_again() {
  Reactor::about_to_wait();
  Returning self;
  std::unique_lock lock(turns_);
  Returning** link = &returning_;
  while (*link != nullptr) link = &(*link)->next;
  *link = &self;
  // Posted work may come too late, as when the node is shut down: then this thread is faster.
  while (is_dispatched_ && !is_turn_loose_) self.wake.wait(lock);
  for (link = &returning_; *link != &self;) link = &(*link)->next;
  *link = self.next;
  is_dispatched_ = true;
  is_turn_loose_ = false;
  --absent_;
  Turn::current(*this)->set_held(true);
}

// Under turns_: nobody dispatches now, but somebody has to.
void StreamConnection::loosen_turn() {
  is_dispatched_ = true;
  is_turn_loose_ = true;
  if (returning_ != nullptr) returning_->wake.notify_one();
}

bool StreamConnection::begin_absence() {
  const std::lock_guard lock(turns_);
  if (absent_ == most_absent) return false;
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
  reactor_->post([self = shared_from_this()] { self->drain_posted(); });
}

// After begin_absence().
void StreamConnection::handle_aside(const Frame& frame) {
  auto work = [self = shared_from_this(), kept = keep(frame)] {
    {
      const ScratchLease scratch;
      self->handle_frame(*scratch, kept, false);
    }
    self->end_absence();
  };
  reactor_->post(std::move(work));
}

}  // namespace rr::channel
