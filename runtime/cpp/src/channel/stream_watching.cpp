// SPDX-License-Identifier: Apache-2.0
// When the reactor watches a socket, and threads of it that are pinned to one.
#include <utility>

#include "runtime/cpp/src/channel/stream_connection.hpp"

namespace rr::channel {
namespace {

// A pinned thread asks again after so many receives that acknowledgements of TCP may be late.
constexpr unsigned receives_of_late_acknowledgements = 64;

}  // namespace

// When nobody reads.
void StreamConnection::watch_input() {
  if (!is_closing_) watch_.go_full(sending_.has_unsent());
}

// With the lease free. Whether something has come through shared memory that nobody has read; if
// not the bell rings for what comes from now on.
bool StreamConnection::has_unread() {
  SharedCarrier* const shared = layers_.shared();
  return shared != nullptr && !is_closing_ && watch_.is_full() && shared->rest();
}

// Where nobody reads, and input is watched for from now on: a socket tells of input that is there,
// a ring does not.
void StreamConnection::ring_or_read() {
  if (has_unread()) read_soon(false);
}

// A caller has ended reading, and nobody goes on.
[[gnu::hot]] void StreamConnection::end_call() {
  const bool has_more = lease_.is_asked_again();
  const Time last_received = keep_alive_.last_received();
  if (watch_.end_call(last_received, lease_.uses(), has_more, sending_.has_unsent())) {
    schedule_watch_timer();
  }
  ring_or_read();
}

[[gnu::hot]] void StreamConnection::schedule_watch_timer() {
  reactor_->schedule(watch_timer_, weak_from_this(), Clock::now() + watch_.period());
}

void StreamConnection::expect() {
  const MutexLock lock(mutex_);
  if (lease_.is_taken()) return;
  watch_input();
  ring_or_read();
}

void StreamConnection::nudge() { send_test(); }

// On the watching thread.
void StreamConnection::look_at_watch() {
  SocketWatch::Look look = SocketWatch::Look::done;
  {
    const MutexLock lock(mutex_);
    if (is_closing_) return;
    look = watch_.look(lease_.uses(), lease_.is_taken(), sending_.has_unsent());
    if (look == SocketWatch::Look::later) schedule_watch_timer();
    if (look != SocketWatch::Look::later && !lease_.is_taken()) ring_or_read();
  }
  if (look == SocketWatch::Look::stuck) on_stuck();
}

// With the read lease.
void StreamConnection::limit_receive_time() {
  if (!has_receive_timeout_) platform::set_receive_timeout(socket_.get(), receive_pause);
  has_receive_timeout_ = true;
}

// With the read lease. A packet that is read alone is acknowledged within the receive, which some
// microseconds are spent for before the packet is handled. A connection on which both sides speak
// acknowledges with what it says next, or after some more packets; this asks for the same. The
// kernel goes back when nothing has come for 40 ms. Channels without TCP refuse, and have nothing
// to acknowledge.
void StreamConnection::acknowledge_late() {
  platform::acknowledge_with_next_segment(socket_.get());
}

// Pinned threads

[[gnu::hot]] void StreamConnection::read_pinned(Scratch& scratch) {
  if (!reactor_->begin_stay()) return;
  std::uint32_t uses = 0;
  unsigned receives = 0;
  bool is_again = false;
  for (bool goes_on = begin_pinned(uses); goes_on;) {
    limit_receive_time();
    const unsigned since = receives++ % receives_of_late_acknowledgements;
    if (pace_.acknowledges_late() && since == 0) acknowledge_late();
    bool is_full = false;
    const Time before = keep_alive_.last_received();
    const Received received = receive(scratch, true, is_full);
    if (since == 1 || since == 2) {
      pace_.look_for_waiting_sender(before, keep_alive_.last_received());
    }
    is_again = leave_read_lease(scratch, true);
    give_way_to_others(std::exchange(scratch.received, 0));
    goes_on = go_on_pinned(received, uses);
  }
  reactor_->end_stay();
  // Where a handler has been slow the socket is watched already, and does not report this again.
  if (is_again) read_soon(false);
}

bool StreamConnection::begin_pinned(std::uint32_t& uses) {
  const MutexLock lock(mutex_);
  if (is_closing_ || lease_.is_taken() || is_paused() || !watch_.is_full()) return false;
  uses = pin();
  return true;
}

[[gnu::hot]] bool StreamConnection::go_on_pinned(Received received, std::uint32_t& uses) {
  answers_wait();
  const MutexLock lock(mutex_);
  const bool is_lone = lease_.uses() == uses;
  if (received == Received::some && is_lone && !is_closing_ && !lease_.is_taken() && !is_paused() &&
      watch_.state() == SocketWatch::State::idle && !reactor_->is_stay_over()) {
    uses = pin();
    return true;
  }
  watch_.unpin();
  if (!lease_.is_taken()) {
    watch_input();
    ring_or_read();
  }
  return false;
}

// Returns what the uses of the lease will be as long as no caller reads.
[[gnu::hot]] std::uint32_t StreamConnection::pin() {
  lease_.take();
  lease_.count_use();
  if (watch_.pin(lease_.uses(), sending_.has_unsent())) schedule_watch_timer();
  return lease_.uses();
}

}  // namespace rr::channel
