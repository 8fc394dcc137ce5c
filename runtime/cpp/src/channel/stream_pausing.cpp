// SPDX-License-Identifier: Apache-2.0
// When a server does not read a connection on, nor hands on what it has read: for want of memory,
// or while the other side does not take its answers. And how long a message may take to come.
#include <algorithm>
#include <utility>

#include "runtime/cpp/src/channel/stream_connection.hpp"
#include "runtime/cpp/src/channel/stream_sizes.hpp"

namespace rr::channel {
namespace {

// When memory was refused it is asked for again after this time.
constexpr Milliseconds memory_pause{40};
// Who has not opened a session sends small messages: so much is received at once.
constexpr std::size_t stranger_receive = 8 * 1024;

}  // namespace

[[gnu::hot]] bool StreamConnection::is_paused() const {
  return strand_.is_full() || is_refused_ || sending_.do_answers_wait();
}

// A client's callers read on, whatever waits. A service that waits for its client may
// have to read on even where that one does not take its answers.
bool StreamConnection::may_callers_read() const {
  return role_ == Role::client || !(strand_.is_full() || is_refused_);
}

// No more may wait to be handled.
bool StreamConnection::is_overdrawn() const {
  return strand_.is_full() && account_ != nullptr && strand_.has_queued() &&
         !Charge(account_).can_add(bytes_beside_frame);
}

// The other side has gone, and with it whoever could want what it has asked for.
bool StreamConnection::is_departed() const { return role_ == Role::server && is_closed(); }

// Memory

// With the read lease: where to receive.
[[gnu::hot]] std::span<std::byte> StreamConnection::room(Scratch& scratch) {
  const std::span<std::byte> room = inbox_.room(scratch);
  if (account_ == nullptr || role_ == Role::client) return room;
  const bool is_stranger =
      !inbox_.is_assembling() && !is_authorised_.load(std::memory_order_relaxed);
  const std::size_t largest = is_stranger          ? stranger_receive
                              : is_beside_others() ? largest_receive_beside_others
                                                   : largest_receive;
  return room.first(std::min(room.size(), largest));
}

// With the read lease, when the account has no room for more of the message that has begun.
StreamConnection::Received StreamConnection::wait_for_memory() {
  const Time now = Clock::now();
  if (refused_since_ == never) refused_since_ = now;
  if (now - refused_since_ > options_->budget.patience) {
    return fail_reading({ErrorCode::out_of_system_resource,
                         "its message does not fit into what the node may hold for its clients"});
  }
  const MutexLock lock(mutex_);
  is_refused_ = true;
  schedule_look(now + memory_pause);
  return Received::nothing;
}

// With the read lease, after bytes have come.
[[gnu::hot]] void StreamConnection::note_assembly() {
  const std::size_t size = inbox_.assembled_size();
  refused_since_ = never;
  if (message_deadline_.is_set() == (size != 0)) return;
  if (size == 0) {
    message_deadline_.end();
    return;
  }
  message_deadline_.begin(size, options_->message_timeout);
  const MutexLock lock(mutex_);
  schedule_look(message_deadline_.due());
}

// One timer looks for all; it is not taken back.
void StreamConnection::schedule_look(Time when) {
  if (when >= look_due_ || is_closing_) return;
  look_due_ = when;
  reactor_->schedule(look_timer_, weak_from_this(), when);
}

// On the watching thread.
void StreamConnection::look_at_message() {
  const Time now = Clock::now();
  bool must_read = false;
  {
    const MutexLock lock(mutex_);
    look_due_ = never;
    if (is_closing_) return;
    must_read = std::exchange(is_refused_, false);
    if (now >= message_deadline_.due()) {
      must_read = must_read || !is_paused();
      if (is_paused()) message_deadline_.restart();
    }
    const Time due = message_deadline_.due();
    if (due > now) schedule_look(due);
  }
  if (must_read) reactor_->post([self = shared_from_this(), now] { self->read_late(now); });
}

// What has come in time may not have been read in time.
void StreamConnection::read_late(Time asked) {
  constexpr Milliseconds late{100};
  if (take_read_lease()) read_as_reactor(true);
  const Time now = Clock::now();
  if (now < message_deadline_.due()) return;
  if (now - asked > late) {
    message_deadline_.restart();
    const MutexLock lock(mutex_);
    schedule_look(message_deadline_.due());
    return;
  }
  close(Error(ErrorCode::operation_timeout, "a message has begun, and did not come in time"));
}

// Answers

bool StreamConnection::look_at_answers() {
  if (!sending_.has_unsent()) flush();  // only held back
  return sending_.check_answers();
}

// As posted work: enough of the answers have left.
void StreamConnection::go_on() {
  bool must_drain = false;
  {
    const MutexLock lock(mutex_);
    message_deadline_.restart();
    must_drain = !strand_.is_taken() && strand_.has_queued();
    if (must_drain) strand_.orphan();
  }
  if (must_drain) reactor_->post([self = shared_from_this()] { self->drain_posted(); });
  if (take_read_lease()) read_as_reactor(true);
}

}  // namespace rr::channel
