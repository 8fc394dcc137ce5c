// SPDX-License-Identifier: Apache-2.0
// How callers share a connection: what they ask leaves together, one of them reads it while they
// wait, and the others follow.
#include <poll.h>

#include <algorithm>
#include <thread>
#include <utility>

#include "runtime/cpp/src/channel/stream_connection.hpp"

namespace rr::channel {

// One receive often brings the answers of several callers, which then ask again one after the
// other. The first of them waits for the rest, for as long as these need a processor to come, and
// sends what all of them ask.
void StreamConnection::send_call(Writer& message, Time now, Priority priority) {
  const bool is_usual = priority == Priority::usual;
  switch (others_come() && is_usual ? gather_call(message) : Gathered::no) {
    case Gathered::no:
      send(message, now, priority);
      break;
    case Gathered::as_first:
      let_others_come();
      flush();
      break;
    case Gathered::as_other:
      break;
  }
}

// Whether callers that were woken have not asked again yet. Those that never will are forgotten,
// one for each call.
bool StreamConnection::others_come() {
  unsigned coming = coming_.load(std::memory_order_relaxed);
  while (coming != 0 &&
         !coming_.compare_exchange_weak(coming, coming - 1, std::memory_order_relaxed)) {
  }
  return coming != 0;
}

// Only the first looks whether it may wait.
StreamConnection::Gathered StreamConnection::gather_call(Writer& message) {
  check_size(message);
  if (message.size() >= Writer::attach_threshold || has_strings() ||
      is_closing_.load(std::memory_order_relaxed)) {
    return Gathered::no;
  }
  const std::lock_guard lock(streaming_);
  if (message.size() > stream_chunk - streamed_size_) return Gathered::no;
  if (!is_gathering_) {
    const unsigned coming = coming_.load(std::memory_order_relaxed);
    if (coming == 0 || has_unsent_ || Clock::now() < crowded_until_) return Gathered::no;
    missing_ = (coming + 1) / 2;
  } else if (missing_ != 0 && --missing_ == 0) {
    return Gathered::no;  // with what the others have left
  }
  gather(message);
  return std::exchange(is_gathering_, true) ? Gathered::as_other : Gathered::as_first;
}

// They are ready to run, maybe on this thread's processor. It is not given up for a while where
// something else has kept it for long.
void StreamConnection::let_others_come() {
  constexpr Milliseconds long_turn{1};
  constexpr Milliseconds crowded_for{50};
  Time before = Clock::now();
  std::size_t gathered = 0;
  while (coming_.load(std::memory_order_relaxed) != 0) {
    const std::size_t now_gathered = streamed_bytes_.load(std::memory_order_relaxed);
    if (now_gathered == gathered) break;  // nobody has come
    gathered = now_gathered;
    std::this_thread::yield();
    const Time now = Clock::now();
    if (now - before > long_turn) crowded_until_ = now + crowded_for;
    before = now;
  }
  const std::lock_guard lock(streaming_);
  is_gathering_ = false;
}

// Waiting

void StreamConnection::claim(Waiter& waiter) {
  const std::lock_guard lock(turns_);
  if (is_closing_ || is_read_ || !may_callers_read()) return;
  begin_lead(waiter);
}

// Under turns_.
void StreamConnection::begin_lead(Waiter& waiter) {
  is_read_ = true;
  lacks_reader_ = false;
  waiter.state.fetch_or(Waiter::reader, std::memory_order_relaxed);
  ++leads_;
  if (watch_ == Watch::full) set_watch(Watch::parked);
}

void StreamConnection::wait(Waiter& waiter, Time deadline, Time now) {
  bool may_lead = waiter.is_reader();
  if (!may_lead) {
    may_lead = follow(waiter, deadline);
    now = coarse_now();
  }
  while (may_lead && !lead(waiter, deadline, now)) {
    may_lead = follow(waiter, deadline);
    now = coarse_now();
  }
}

void StreamConnection::resign(Waiter& waiter) {
  bool is_end = false;
  {
    const std::lock_guard lock(turns_);
    if (!waiter.is_reader()) return;
    waiter.state.fetch_and(~Waiter::reader, std::memory_order_relaxed);
    // It comes again with those that it has woken.
    if (std::exchange(has_woken_, false)) coming_.fetch_add(1, std::memory_order_relaxed);
    is_end = is_closing_;
    if (!is_end) {
      is_read_ = false;
      lacks_reader_ = followers_ != nullptr;
      if (followers_ == nullptr) park_or_watch();
    }
  }
  if (is_end) {
    finish_close();
  } else if (lacks_reader_ && passing_ == 0) {
    find_reader();
  }
}

// A caller that others follow has ended reading. It will often be back before they have run whom it
// has woken, and read on; the first of these makes another the reader if not.
void StreamConnection::pass() {
  passing_.fetch_sub(1);
  if (lacks_reader_) find_reader();
}

void StreamConnection::find_reader() {
  const SleepWord* next = nullptr;
  {
    const std::lock_guard lock(turns_);
    if (!lacks_reader_.exchange(false) || is_read_ || is_closing_) return;
    if (may_callers_read()) next = choose_next();
    is_read_ = next != nullptr;
    if (!is_read_) park_or_watch();
  }
  if (next != nullptr) wake(next);
}

// Returns true when the waiter is to read itself, false when it is done or out of time.
bool StreamConnection::follow(Waiter& waiter, Time deadline) {
  Reactor::about_to_wait();
  constexpr std::uint32_t woken = Waiter::reader | Waiter::done;
  std::uint32_t state = 0;
  if (begin_following(waiter)) {
    while (((state = waiter.state.load(std::memory_order_acquire)) & woken) == 0) {
      if (sleep_on(waiter.state, state, deadline)) continue;
      const std::lock_guard lock(turns_);
      if (unlink(waiter)) return false;
      deadline = never;  // it is being woken
    }
  } else {
    state = waiter.state.load(std::memory_order_acquire);
  }
  if ((state & Waiter::answered) != 0) pass();
  return (state & Waiter::reader) != 0;
}

// False when the waiter is done, or the reader now: who was it left between the claim and now.
bool StreamConnection::begin_following(Waiter& waiter) {
  const std::lock_guard lock(turns_);
  if (waiter.is_done()) return false;
  if (!is_read_ && !is_closing_ && may_callers_read()) {
    begin_lead(waiter);
    return false;
  }
  waiter.next = std::exchange(followers_, &waiter);
  return true;
}

// Under turns_. False when it is no follower.
bool StreamConnection::unlink(Waiter& waiter) {
  for (Waiter** link = &followers_; *link != nullptr; link = &(*link)->next) {
    if (*link != &waiter) continue;
    *link = std::exchange(waiter.next, nullptr);
    return true;
  }
  return false;
}

// Under turns_, with the read turn: hands it to the caller that has waited longest, which is to be
// woken there. Null when there is none.
const SleepWord* StreamConnection::choose_next() {
  if (followers_ == nullptr) return nullptr;
  Waiter* oldest = followers_;
  while (oldest->next != nullptr) oldest = oldest->next;
  unlink(*oldest);
  oldest->state.fetch_or(Waiter::reader, std::memory_order_release);
  return &oldest->state;
}

// False when the connection must not be read for a while.
bool StreamConnection::lead(Waiter& waiter, Time deadline, Time now) {
  Reactor::about_to_wait();
  limit_receive_time();
  // Nearly always the first receive brings the answer.
  bool may_block = deadline - now > 2 * receive_pause;
  bool is_over = true;
  {
    const ScratchLease scratch;
    while (!waiter.is_done() && !is_closing_.load(std::memory_order_relaxed)) {
      may_block = may_block || may_block_until(deadline);
      bool is_full = false;
      const Received received = receive(*scratch, may_block, is_full);
      may_block = false;
      const bool is_left = !scratch->waiting.empty() || !scratch->deferred.empty();
      if (is_left) leave_to_reactor(*scratch);
      if (received == Received::end || waiter.is_done()) break;
      if (is_left && role_ == Role::client) wait_until_handled(waiter, deadline);
      // What others send without end must not keep the call from its end.
      if (Clock::now() >= deadline) break;
      if (role_ == Role::server) {
        const std::lock_guard lock(turns_);
        is_over = may_callers_read();
        if (!is_over) break;
      }
    }
  }
  resign(waiter);
  return is_over;
}

// What a caller has read that is not for callers.
void StreamConnection::leave_to_reactor(Scratch& scratch) {
  bool must_post = false;
  {
    const std::lock_guard lock(turns_);
    hand_on(scratch, false, must_post);
  }
  if (must_post) drain_soon();
  for (std::function<void()>& later : scratch.deferred) reactor_->post(std::move(later));
  scratch.deferred.clear();
}

// A client's callers read on, whatever waits to be handled, until that is more than the service may
// make the client hold.
void StreamConnection::wait_until_handled(const Waiter& waiter, Time deadline) {
  constexpr Milliseconds look_period{5};
  while (!waiter.is_done() && !is_closing_.load(std::memory_order_relaxed)) {
    {
      const std::lock_guard lock(turns_);
      if (!is_overdrawn()) return;
    }
    const Time now = Clock::now();
    if (now >= deadline) return;
    std::this_thread::sleep_until(std::min(deadline, now + look_period));
  }
}

// A blocking receive would be late for a deadline that is near: then poll() waits for bytes.
bool StreamConnection::may_block_until(Time deadline) {
  if (deadline == never || deadline - Clock::now() > receive_pause) return true;
  wait_for(socket_.get(), POLLIN, deadline);
  return false;
}

void StreamConnection::finish(Waiter& waiter) {
  {
    const std::lock_guard lock(turns_);
    const bool is_asleep = unlink(waiter);
    waiter.state.fetch_or(Waiter::done, std::memory_order_release);
    if (!is_asleep) return;
    coming_.fetch_add(1, std::memory_order_relaxed);
  }
  wake(&waiter.state);
}

// With the read turn, which is a caller's or the reactor's.
void StreamConnection::finish_answered(Waiter& waiter) {
  if (waiter.is_reader()) {
    waiter.state.fetch_or(Waiter::done, std::memory_order_release);  // it is not asleep
    return;
  }
  const std::lock_guard lock(turns_);
  if (unlink(waiter)) {
    waiter.state.fetch_or(Waiter::answered, std::memory_order_relaxed);
    *answered_end_ = &waiter;
    answered_end_ = &waiter.next;
  } else {
    waiter.state.fetch_or(Waiter::done, std::memory_order_release);
  }
}

// With the read turn, after a receive.
void StreamConnection::wake_answered() {
  if (answered_ == nullptr) return;
  Waiter* waiter = std::exchange(answered_, nullptr);
  answered_end_ = &answered_;
  has_woken_ = true;
  unsigned count = 0;
  for (const Waiter* each = waiter; each != nullptr; each = each->next) ++count;
  coming_.fetch_add(count, std::memory_order_relaxed);
  passing_.fetch_add(count);
  while (waiter != nullptr) {
    Waiter* const next = waiter->next;
    waiter->state.fetch_or(Waiter::done, std::memory_order_release);  // it may be gone now
    wake(&waiter->state);
    waiter = next;
  }
}

}  // namespace rr::channel
