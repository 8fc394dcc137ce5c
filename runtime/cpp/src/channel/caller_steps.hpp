// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <atomic>
#include <cstdint>

#include "rr/mutex.hpp"
#include "runtime/cpp/src/channel/gathering_steps.hpp"
#include "runtime/cpp/src/channel/time.hpp"
#include "runtime/cpp/src/channel/waiter.hpp"

namespace rr::channel {

/// How callers share a connection: one of them reads while they wait (the leader), and the others
/// follow. See ReadLease. These are functions of the connection, which has the lease, the lock, and
/// what else a caller that begins or ends to read changes.
template <class Connection>
struct CallerSteps {
  using Sync = typename Connection::Sync;
  using Lock = typename Sync::Lock;
  using Waiter = BasicWaiter<Sync>;
  using SleepWord = typename Sync::SleepWord;

  /// Makes the caller the leader if no thread reads.
  static void claim(Connection& connection, Waiter& waiter);
  /// Returns when the waiter is done, or at the deadline. `now` need not be exact.
  static void wait(Connection& connection, Waiter& waiter, Time deadline, Time now);
  /// Ends to lead.
  static void resign(Connection& connection, Waiter& waiter);
  /// The waiter is done. It may be gone when this returns.
  static void finish(Connection& connection, Waiter& waiter);
  /// The same with the read lease, which is a caller's or the reactor's, while the answers of one
  /// receive are looked at.
  static void finish_answered(Connection& connection, Waiter& waiter);
  /// The reactor gives the lease to a follower, which is to be woken there, or back: null.
  static const SleepWord* hand_on(Connection& connection) RR_REQUIRES(connection.mutex_);
  /// Sends the call of one of several callers that were woken together and ask again. The first of
  /// them waits for the others, and sends what all of them ask. False when the call is to be sent
  /// alone.
  template <class Writer>
  static bool send_together(Connection& connection, Writer& message);

 private:
  static bool follow(Connection& connection, Waiter& waiter, Time deadline);
  static bool begin_following(Connection& connection, Waiter& waiter);
  static void find_reader(Connection& connection);
};

template <class Connection>
[[gnu::hot]] void CallerSteps<Connection>::claim(Connection& connection, Waiter& waiter) {
  const Lock lock(connection.mutex_);
  if (connection.is_closing_ || connection.lease_.is_taken() || !connection.may_callers_read()) {
    return;
  }
  connection.begin_lead(waiter);
}

template <class Connection>
[[gnu::hot]] void CallerSteps<Connection>::wait(Connection& connection, Waiter& waiter,
                                                Time deadline, Time now) {
  bool may_lead = waiter.is_reader();
  if (!may_lead) {
    may_lead = follow(connection, waiter, deadline);
    now = Sync::coarse_now();
  }
  while (may_lead && !connection.lead(waiter, deadline, now)) {
    may_lead = follow(connection, waiter, deadline);
    now = Sync::coarse_now();
  }
}

template <class Connection>
[[gnu::hot]] void CallerSteps<Connection>::resign(Connection& connection, Waiter& waiter) {
  bool is_end = false;
  {
    const Lock lock(connection.mutex_);
    if (!waiter.is_reader()) return;
    connection.lease_.end_lead(waiter);
    is_end = connection.is_closing_;
    if (!is_end && connection.lease_.give_back_by_leader()) connection.end_call();
  }
  if (is_end) {
    connection.finish_close();
  } else if (connection.lease().must_search()) {
    find_reader(connection);
  }
}

template <class Connection>
void CallerSteps<Connection>::find_reader(Connection& connection) {
  const SleepWord* next = nullptr;
  {
    const Lock lock(connection.mutex_);
    if (!connection.lease_.begin_search() || connection.is_closing_) return;
    if (connection.may_callers_read()) next = connection.lease_.pass_on();
    if (next == nullptr) connection.end_call();
  }
  if (next != nullptr) Sync::wake(next);
}

// Returns true when the waiter is to read itself, false when it is done or out of time.
template <class Connection>
bool CallerSteps<Connection>::follow(Connection& connection, Waiter& waiter, Time deadline) {
  connection.about_to_wait();
  constexpr std::uint32_t woken = Waiter::reader | Waiter::done;
  std::uint32_t state = 0;
  if (begin_following(connection, waiter)) {
    while (((state = waiter.state.load(std::memory_order_acquire)) & woken) == 0) {
      if (Sync::sleep_on(waiter.state, state, deadline)) continue;
      const Lock lock(connection.mutex_);
      if (connection.lease_.unfollow(waiter)) return false;
      deadline = never;  // it is being woken
    }
  } else {
    state = waiter.state.load(std::memory_order_acquire);
  }
  if ((state & Waiter::answered) != 0 && connection.lease().pass_answered()) {
    find_reader(connection);
  }
  return (state & Waiter::reader) != 0;
}

// False when the waiter is done, or the leader now: no thread has read between the claim and now.
template <class Connection>
bool CallerSteps<Connection>::begin_following(Connection& connection, Waiter& waiter) {
  const Lock lock(connection.mutex_);
  if (waiter.is_done()) return false;
  if (!connection.lease_.is_taken() && !connection.is_closing_ && connection.may_callers_read()) {
    connection.begin_lead(waiter);
    return false;
  }
  connection.lease_.follow(waiter);
  return true;
}

template <class Connection>
void CallerSteps<Connection>::finish(Connection& connection, Waiter& waiter) {
  {
    const Lock lock(connection.mutex_);
    if (!connection.lease_.finish(waiter)) return;
  }
  Sync::wake(&waiter.state);
}

template <class Connection>
[[gnu::hot]] void CallerSteps<Connection>::finish_answered(Connection& connection, Waiter& waiter) {
  if (waiter.is_reader()) {
    connection.lease().finish_leader(waiter);
    return;
  }
  const Lock lock(connection.mutex_);
  connection.lease_.finish_after_receive(waiter);
}

template <class Connection>
auto CallerSteps<Connection>::hand_on(Connection& connection) -> const SleepWord* {
  if (connection.may_callers_read()) {
    if (const SleepWord* const next = connection.lease_.pass_on()) return next;
  }
  connection.lease_.give_back();
  return nullptr;
}

template <class Connection>
template <class Writer>
bool CallerSteps<Connection>::send_together(Connection& connection, Writer& message) {
  const auto& expected = connection.lease().expected_callers();
  switch (connection.sending_.cork(message, expected.load(std::memory_order_relaxed))) {
    case Corked::no:
      return false;
    case Corked::first:
      connection.sending_.uncork(expected);
      connection.flush();
      return true;
    case Corked::joined:
      return true;
  }
  return false;
}

}  // namespace rr::channel
