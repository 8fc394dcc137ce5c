// SPDX-License-Identifier: Apache-2.0
// When the reactor watches a socket, and threads of it that stay with one.
#include <netinet/in.h>
#include <netinet/tcp.h>
#include <sys/epoll.h>
#include <sys/socket.h>
#include <sys/time.h>

#include <utility>

#include "runtime/cpp/src/channel/stream_connection.hpp"

namespace rr::channel {
namespace {

// Who stays asks again after so many receives that acknowledgements of TCP may be late.
constexpr unsigned receives_of_late_acknowledgements = 64;

}  // namespace

// Under turns_, when a caller has ended reading. A call that ended in the same tick of the clock as
// the one before is taken for one of many.
void StreamConnection::park_or_watch() {
  const Time now = last_received_.load(std::memory_order_relaxed);
  const bool is_tight = std::exchange(last_lead_, now) == now || is_park_timed_;
  if (std::exchange(read_again_, false) || !is_tight) {
    watch_again();
  } else if (!std::exchange(is_park_timed_, true)) {
    leads_seen_ = leads_;
    reactor_->schedule(park_timer_, weak_from_this(), Clock::now() + park_time());
  }
}

// Under turns_. For how long without a call, or in the same handler, a parked socket stays so.
Milliseconds StreamConnection::park_time() const { return Milliseconds(is_stayed_with_ ? 5 : 1); }

// With the read turn.
void StreamConnection::limit_receive_time() {
  if (std::exchange(has_receive_timeout_, true)) return;
  timeval pause{};
  pause.tv_usec = std::chrono::microseconds(receive_pause).count();
  setsockopt(socket_.get(), SOL_SOCKET, SO_RCVTIMEO, &pause, sizeof pause);
}

void StreamConnection::expect() {
  const std::lock_guard lock(turns_);
  if (!is_read_) watch_again();
}

void StreamConnection::nudge() { send_test(); }

// Under turns_.
void StreamConnection::set_watch(Watch watch) {
  if (self_ == nullptr) return;
  watch_ = watch;
  const bool was_watched = is_watched_;
  std::uint32_t events = 0;
  if (watch == Watch::full) {
    events = EPOLLIN | EPOLLOUT | EPOLLRDHUP;
  } else if (has_unsent_) {
    events = EPOLLOUT;
  }
  if (events == 0) {
    reactor_->remove(socket_.get());  // cheaper for the kernel than watching for nothing
  } else if (was_watched) {
    reactor_->change(socket_.get(), events, *this);
  } else {
    reactor_->add(socket_.get(), events, *this);
  }
  is_watched_ = events != 0;
}

// Under turns_, when nobody reads: the reactor looks at once if there is something already.
void StreamConnection::watch_again() {
  if (watch_ == Watch::parked && !is_closing_) set_watch(Watch::full);
}

// On the watching thread.
void StreamConnection::unpark() {
  Milliseconds next{};
  bool is_stuck = false;
  {
    const std::lock_guard lock(turns_);
    const bool is_quiet = std::exchange(leads_seen_, leads_) == leads_;
    if (is_quiet && !(is_stayed_with_ && is_read_)) {
      is_park_timed_ = false;
      if (!is_read_) watch_again();
      is_stuck = is_stayed_with_;
    }
    next = park_time();
    if (!is_park_timed_ && !is_stuck) return;
  }
  if (is_stuck) {
    on_stuck();
  } else {
    reactor_->schedule(park_timer_, weak_from_this(), Clock::now() + next);
  }
}

// Staying

// With the read turn, after a receive: whether messages have come close after each other for a
// while, in which no caller has read: it would have to follow. Asked again, only after another
// while.
bool StreamConnection::is_busy(Time last_received) {
  constexpr Milliseconds close{8};  // the clock has steps of 4 ms
  constexpr unsigned while_of_receives = 64;
  const bool is_close = last_received_.load(std::memory_order_relaxed) - last_received < close;
  const bool is_lone = std::exchange(busy_leads_, leads_) == leads_;  // the turn keeps leads_
  busy_receives_ = is_close && is_lone ? busy_receives_ + 1 : 0;
  if (busy_receives_ < while_of_receives) return false;
  busy_receives_ = 0;
  return true;
}

// With the read turn. A packet that is read alone is acknowledged within the receive, which some
// microseconds are spent for before the packet is handled. A connection on which both sides speak
// acknowledges with what it says next, or after some more packets; this asks for the same. The
// kernel goes back when nothing has come for 40 ms. Channels without TCP refuse, and have nothing
// to acknowledge.
void StreamConnection::acknowledge_late() {
  const int at_once = 0;
  setsockopt(socket_.get(), IPPROTO_TCP, TCP_QUICKACK, &at_once, sizeof at_once);
}

// With the read turn. A sender that has one segment under way at a time, as small devices do, gets
// its acknowledgement after 40 ms then, right after this side has asked: it is not to be made to
// wait again.
void StreamConnection::look_for_waiting_sender(Time before) {
  const auto pause = last_received_.load(std::memory_order_relaxed) - before;
  if (pause >= Milliseconds(36) && pause < Milliseconds(64)) acknowledges_late_ = false;
}

void StreamConnection::stay(Scratch& scratch) {
  if (!reactor_->begin_stay()) return;
  std::uint32_t leads = 0;
  unsigned receives = 0;
  for (bool goes_on = begin_staying(leads); goes_on;) {
    limit_receive_time();
    const unsigned since = receives++ % receives_of_late_acknowledgements;
    if (acknowledges_late_ && since == 0) acknowledge_late();
    bool is_full = false;
    const Time before = last_received_.load(std::memory_order_relaxed);
    const Received received = receive(scratch, true, is_full);
    if (since == 1 || since == 2) look_for_waiting_sender(before);
    leave_read_turn(scratch, true);
    goes_on = go_on_staying(received, leads);
  }
  reactor_->end_stay();
}

bool StreamConnection::begin_staying(std::uint32_t& leads) {
  const std::lock_guard lock(turns_);
  if (is_closing_ || is_read_ || is_paused() || watch_ != Watch::full) return false;
  is_stayed_with_ = true;
  set_watch(Watch::parked);
  leads = read_to_stay();
  return true;
}

bool StreamConnection::go_on_staying(Received received, std::uint32_t& leads) {
  answers_wait();
  const std::lock_guard lock(turns_);
  const bool is_lone = leads_ == leads;
  if (received == Received::some && is_lone && !is_closing_ && !is_read_ && !is_paused() &&
      watch_ == Watch::parked && !reactor_->is_stay_over()) {
    leads = read_to_stay();
    return true;
  }
  is_stayed_with_ = false;
  if (!is_read_) watch_again();
  return false;
}

// Under turns_. Returns what leads_ will be as long as no caller reads.
std::uint32_t StreamConnection::read_to_stay() {
  is_read_ = true;
  ++leads_;
  if (!std::exchange(is_park_timed_, true)) {
    leads_seen_ = leads_;
    reactor_->schedule(park_timer_, weak_from_this(), Clock::now() + park_time());
  }
  return leads_;
}

}  // namespace rr::channel
