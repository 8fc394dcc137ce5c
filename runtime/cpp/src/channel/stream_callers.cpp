// SPDX-License-Identifier: Apache-2.0
// How callers share a connection: one of them reads it while they wait, and the others follow. How
// they take turns is in caller_steps.hpp.
#include <algorithm>
#include <thread>
#include <utility>

#include "runtime/cpp/src/channel/caller_steps.hpp"
#include "runtime/cpp/src/channel/stream_connection.hpp"

namespace rr::channel {

[[gnu::hot]] void StreamConnection::claim(Waiter& waiter) {
  CallerSteps<StreamConnection>::claim(*this, waiter);
}

// With the lease free.
void StreamConnection::begin_lead(Waiter& waiter) {
  lease_.lead(waiter);
  if (watch_.is_full()) watch_.go_idle(sending_.has_unsent());
}

[[gnu::hot]] void StreamConnection::wait(Waiter& waiter, Time deadline, Time now) {
  CallerSteps<StreamConnection>::wait(*this, waiter, deadline, now);
}

[[gnu::hot]] void StreamConnection::resign(Waiter& waiter) {
  CallerSteps<StreamConnection>::resign(*this, waiter);
}

// False when the connection must not be read for a while.
[[gnu::hot]] bool StreamConnection::lead(Waiter& waiter, Time deadline, Time now) {
  Reactor::about_to_wait();
  limit_receive_time();
  // Nearly always the first receive brings the answer.
  bool may_block = deadline - now > 2 * receive_pause;
  bool is_over = true;
  {
    const ScratchLease scratch;
    while (!waiter.is_done() && !is_closed()) {
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
      is_over = may_lead_on();
      if (!is_over) break;
    }
  }
  resign(waiter);
  return is_over;
}

bool StreamConnection::may_lead_on() {
  if (role_ == Role::client) return true;
  const MutexLock lock(mutex_);
  return may_callers_read();
}

// What a caller has read that is not for callers.
void StreamConnection::leave_to_reactor(Scratch& scratch) {
  bool must_post = false;
  {
    const MutexLock lock(mutex_);
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
  while (!waiter.is_done() && !is_closed()) {
    {
      const MutexLock lock(mutex_);
      if (!is_overdrawn()) return;
    }
    const Time now = Clock::now();
    if (now >= deadline) return;
    std::this_thread::sleep_until(std::min(deadline, now + look_period));
  }
}

// A blocking receive would be late for a deadline that is near: then bytes are waited for first.
bool StreamConnection::may_block_until(Time deadline) {
  if (deadline == never || deadline - Clock::now() > receive_pause) return true;
  if (SharedCarrier* const shared = layers_.shared()) {
    shared->wait(deadline);
  } else {
    platform::wait_for(socket_.get(), ready::input, deadline);
  }
  return false;
}

void StreamConnection::finish(Waiter& waiter) {
  CallerSteps<StreamConnection>::finish(*this, waiter);
}

[[gnu::hot]] void StreamConnection::finish_answered(Waiter& waiter) {
  CallerSteps<StreamConnection>::finish_answered(*this, waiter);
}

}  // namespace rr::channel
