// SPDX-License-Identifier: Apache-2.0
// When a server does not read a connection on, nor hands on what it has read: for want of memory,
// or while the other side does not take its answers. And how long a message may take to come.
#include <algorithm>
#include <mutex>
#include <utility>

#include "runtime/cpp/src/channel/dispatch_turn.hpp"
#include "runtime/cpp/src/channel/stream_connection.hpp"

namespace rr::channel {
namespace {

// When memory was refused it is asked for again after this time.
constexpr Milliseconds memory_pause{40};
// Who has not opened a session sends small messages: so much is received at once.
constexpr std::size_t stranger_receive = 8 * 1024;
// So that others are looked at before a large message is whole.
constexpr std::size_t largest_receive = std::size_t{128} * 1024;
// The slowest that a message may come.
constexpr std::size_t bytes_a_second = 64 * 1024;

}  // namespace

// Under turns_.
bool StreamConnection::is_paused() const {
  return is_stalled_ || is_refused_ || answers_wait_.load(std::memory_order_relaxed);
}

// Under turns_. A client's callers read on, whatever waits. A service that waits for its client may
// have to read on even where that one does not take its answers.
bool StreamConnection::may_callers_read() const {
  return role_ == Role::client || !(is_stalled_ || is_refused_);
}

// Under turns_: no more may wait to be handled.
bool StreamConnection::is_overdrawn() const {
  return is_stalled_ && account_ != nullptr && queue_ && !queue_->empty() &&
         !Charge(account_).can_add(bytes_beside_frame);
}

// The other side has gone, and with it whoever could want what it has asked for.
bool StreamConnection::is_departed() const {
  return role_ == Role::server && is_closing_.load(std::memory_order_relaxed);
}

// Under turns_.
std::unique_ptr<std::deque<Frame>> StreamConnection::take_queue() {
  queued_bytes_ = 0;
  return std::exchange(queue_, nullptr);
}

// Memory

// With the read turn: where to receive.
std::span<std::byte> StreamConnection::room(Scratch& scratch) {
  const std::span<std::byte> room = inbox_.room(scratch);
  if (account_ == nullptr || role_ == Role::client) return room;
  const bool is_stranger =
      !inbox_.is_assembling() && !is_authorised_.load(std::memory_order_relaxed);
  return room.first(std::min(room.size(), is_stranger ? stranger_receive : largest_receive));
}

// With the read turn, when the account has no room for more of the message that has begun.
StreamConnection::Received StreamConnection::wait_for_memory() {
  const Time now = Clock::now();
  if (refused_since_ == never) refused_since_ = now;
  if (now - refused_since_ > options_->budget.patience) {
    return fail_reading({ErrorCode::out_of_system_resource,
                         "its message does not fit into what the node may hold for its clients"});
  }
  const std::lock_guard lock(turns_);
  is_refused_ = true;
  schedule_look(now + memory_pause);
  return Received::nothing;
}

// With the read turn, after bytes have come.
void StreamConnection::note_assembly() {
  const std::size_t size = inbox_.assembled_size();
  const bool is_known = message_due_.load(std::memory_order_relaxed) != never;
  refused_since_ = never;
  if (is_known == (size != 0)) return;
  if (size == 0) {
    message_due_.store(never, std::memory_order_relaxed);
    return;
  }
  const Milliseconds time =
      saturated(options_->message_timeout) + Milliseconds(size * 1000 / bytes_a_second);
  const Time due = after(coarse_now(), time);
  message_time_.store(time, std::memory_order_relaxed);
  message_due_.store(due, std::memory_order_relaxed);
  const std::lock_guard lock(turns_);
  schedule_look(due);
}

// Under turns_. One timer looks for all; it is not taken back.
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
    const std::lock_guard lock(turns_);
    look_due_ = never;
    if (is_closing_) return;
    must_read = std::exchange(is_refused_, false);
    if (now >= message_due_.load()) {
      must_read = must_read || !is_paused();
      if (is_paused()) give_time();
    }
    const Time due = message_due_;
    if (due > now) schedule_look(due);
  }
  if (must_read) reactor_->post([self = shared_from_this(), now] { self->read_late(now); });
}

// What has come in time may not have been read in time.
void StreamConnection::read_late(Time asked) {
  constexpr Milliseconds late{100};
  if (take_read_turn()) read_as_reactor(true);
  const Time now = Clock::now();
  if (now < message_due_.load()) return;
  if (now - asked > late) {
    give_time();
    const std::lock_guard lock(turns_);
    schedule_look(message_due_);
    return;
  }
  close(Error(ErrorCode::operation_timeout, "a message has begun, and did not come in time"));
}

// The message could not be read meanwhile.
void StreamConnection::give_time() {
  Time due = message_due_;
  if (due != never) message_due_.compare_exchange_strong(due, after(Clock::now(), message_time_));
}

// Answers

// Under sending_: bytes that may wait before requests do.
std::size_t StreamConnection::most_answers() const {
  return is_over_.load(std::memory_order_relaxed)
             ? std::min(stream_chunk, options_->answer_queue_limit)
             : options_->answer_queue_limit;
}

bool StreamConnection::look_at_answers() {
  if (!has_unsent_) flush();  // only held back
  const std::lock_guard lock(sending_);
  if (has_unsent_ && !is_closing_ && waiting_answers() > most_answers()) answers_wait_ = true;
  return answers_wait_.load(std::memory_order_relaxed);
}

// As posted work: enough of the answers have left.
void StreamConnection::go_on() {
  bool must_drain = false;
  {
    const std::lock_guard lock(turns_);
    give_time();
    must_drain = !is_dispatched_ && queue_ && !queue_->empty();
    if (must_drain) loosen_turn();
  }
  if (must_drain) reactor_->post([self = shared_from_this()] { self->drain_posted(); });
  if (take_read_turn()) read_as_reactor(true);
}

}  // namespace rr::channel
