// SPDX-License-Identifier: Apache-2.0
// How callers wait: one of them reads the connection, the others follow.
#include <netinet/in.h>
#include <netinet/tcp.h>
#include <poll.h>
#include <sys/epoll.h>
#include <sys/socket.h>
#include <sys/time.h>

#include <utility>

#include "runtime/cpp/src/channel/stream_connection.hpp"

namespace rr::channel {
namespace {

// A receive returns after this time to look at the deadline, or to give the thread back to the
// reactor; set once per socket, which is cheaper than waiting with poll() each time.
constexpr Milliseconds receive_pause{100};
// Who stays asks again after so many receives that acknowledgements of TCP may be late.
constexpr unsigned receives_of_late_acknowledgements = 64;

}  // namespace

void StreamConnection::claim(Waiter& waiter) {
  const std::lock_guard lock(turns_);
  if (is_closing_ || is_read_) return;
  begin_lead(waiter);
}

// Under turns_.
void StreamConnection::begin_lead(Waiter& waiter) {
  is_read_ = true;
  waiter.is_reader = true;
  ++leads_;
  if (watch_ == Watch::full) set_watch(Watch::parked);
}

void StreamConnection::wait(Waiter& waiter, Time deadline, Time now) {
  if (waiter.is_reader) {
    lead(waiter, deadline, now);
  } else if (follow(waiter, deadline)) {
    lead(waiter, deadline, coarse_now());
  }
}

void StreamConnection::resign(Waiter& waiter) {
  {
    const std::lock_guard lock(turns_);
    if (!waiter.is_reader.exchange(false)) return;
    if (!is_closing_) {
      if (followers_ != nullptr) {
        promote_next();
      } else {
        is_read_ = false;
        park_or_watch();
      }
      return;
    }
  }
  finish_close();
}

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

// Returns true when the waiter is to read itself, false when it is done or out of time.
bool StreamConnection::follow(Waiter& waiter, Time deadline) {
  Reactor::about_to_wait();
  std::condition_variable wake;
  std::unique_lock lock(turns_);
  waiter.wake = &wake;
  waiter.next = std::exchange(followers_, &waiter);
  while (!waiter.is_done && !waiter.is_reader) {
    if (!is_read_ && !is_closing_) {
      begin_lead(waiter);  // the reader left between the claim and now
      break;
    }
    if (Clock::now() >= deadline) break;
    wait_until(wake, lock, deadline);
  }
  for (Waiter** link = &followers_; *link != nullptr; link = &(*link)->next) {
    if (*link != &waiter) continue;
    *link = waiter.next;
    break;
  }
  waiter.next = nullptr;
  waiter.wake = nullptr;
  return waiter.is_reader;
}

// Under turns_, with the read turn: hands it to the caller that has waited longest.
void StreamConnection::promote_next() {
  Waiter* oldest = followers_;
  while (oldest->next != nullptr) oldest = oldest->next;
  oldest->is_reader = true;
  oldest->wake->notify_one();
}

void StreamConnection::lead(Waiter& waiter, Time deadline, Time now) {
  Reactor::about_to_wait();
  limit_receive_time();
  // Nearly always the first receive brings the answer.
  bool may_block = deadline - now > 2 * receive_pause;
  {
    const ScratchLease scratch;
    while (!waiter.is_done.load(std::memory_order_acquire) &&
           !is_closing_.load(std::memory_order_relaxed)) {
      may_block = may_block || may_block_until(deadline);
      bool is_full = false;
      const Received received = receive(*scratch, may_block, is_full);
      may_block = false;
      if (!scratch->waiting.empty() || !scratch->laters.empty()) leave_to_reactor(*scratch);
      if (received == Received::end) break;
      if (received == Received::nothing && Clock::now() >= deadline) break;
    }
  }
  resign(waiter);
}

// With the read turn.
void StreamConnection::limit_receive_time() {
  if (std::exchange(has_receive_timeout_, true)) return;
  timeval pause{};
  pause.tv_usec = std::chrono::microseconds(receive_pause).count();
  setsockopt(socket_.get(), SOL_SOCKET, SO_RCVTIMEO, &pause, sizeof pause);
}

// What a caller has read that is not for callers.
void StreamConnection::leave_to_reactor(Scratch& scratch) {
  bool must_post = false;
  {
    const std::lock_guard lock(turns_);
    hand_on(scratch, false, must_post);
  }
  if (must_post) reactor_->post([self = shared_from_this()] { self->drain_posted(); });
  for (std::function<void()>& later : scratch.laters) reactor_->post(std::move(later));
  scratch.laters.clear();
}

// A blocking receive would be late for a deadline that is near: then poll() waits for bytes.
bool StreamConnection::may_block_until(Time deadline) {
  if (deadline == never || deadline - Clock::now() > receive_pause) return true;
  wait_for(socket_.get(), POLLIN, deadline);
  return false;
}

void StreamConnection::finish(Waiter& waiter) {
  if (waiter.is_reader.load(std::memory_order_relaxed)) {
    waiter.is_done.store(true, std::memory_order_release);  // it is not asleep
    return;
  }
  const std::lock_guard lock(turns_);
  waiter.is_done = true;
  if (waiter.wake != nullptr) waiter.wake->notify_one();
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
  if (is_closing_ || is_read_ || is_stalled_ || watch_ != Watch::full) return false;
  is_stayed_with_ = true;
  set_watch(Watch::parked);
  leads = read_to_stay();
  return true;
}

bool StreamConnection::go_on_staying(Received received, std::uint32_t& leads) {
  const std::lock_guard lock(turns_);
  const bool is_lone = leads_ == leads;
  if (received == Received::some && is_lone && !is_closing_ && !is_read_ && !is_stalled_ &&
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
