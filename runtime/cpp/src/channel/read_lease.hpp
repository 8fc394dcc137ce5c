// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <atomic>
#include <cstdint>
#include <utility>

#include "runtime/cpp/src/channel/synchronization.hpp"
#include "runtime/cpp/src/channel/waiter.hpp"

namespace rr::channel {

/// The right to receive from one connection. One thread at a time has it: a caller that waits for
/// its answer (the leader), or a thread of the reactor. User code never runs with it.
///
/// Callers that wait while another thread reads are followers. A follower sleeps on its state until
/// it is answered, or gets the lease. Those whose answers came in one receive are woken together;
/// the leader is mostly back with its next call before they run. So a leader that ends while others
/// follow leaves the lease free ("lacks a reader"), and the first answered follower that runs looks
/// for another leader if there is none by then.
///
///     free ── take() ──▶ taken by the reactor ── give_back() ──▶ free
///     free ── lead() ──▶ led by a caller ─────── end_lead() ───▶ free, lacks a reader if others
///     follow taken or led ── pass_on() ──▶ led by the follower that has waited longest
///
/// All of it under the connection's lock, unless a function says otherwise.
template <class Sync>
class BasicReadLease {
 public:
  using Waiter = BasicWaiter<Sync>;
  using SleepWord = typename Sync::SleepWord;
  template <class T>
  using Atomic = typename Sync::template Atomic<T>;
  template <class T>
  using Plain = typename Sync::template Plain<T>;

  BasicReadLease() = default;
  BasicReadLease(const BasicReadLease&) = delete;
  BasicReadLease& operator=(const BasicReadLease&) = delete;

  [[nodiscard]] bool is_taken() const { return is_taken_; }
  /// For the reactor, or for ever by the thread that ends the connection. True when it was free.
  bool take() { return !std::exchange(is_taken_, true); }
  void give_back() { is_taken_ = false; }
  /// There may be more to read than the thread that has the lease has seen.
  void ask_again() { is_asked_again_ = true; }
  /// Whether that was said since this was asked last.
  bool is_asked_again() { return std::exchange(is_asked_again_, false); }

  /// The free lease goes to a caller.
  void lead(Waiter& waiter);
  /// The caller does not wait any more: it reads no longer, and still has the lease.
  void end_lead(Waiter& waiter);
  /// After end_lead(), when the connection has not ended. True when nobody follows.
  bool give_back_by_leader();
  /// The caller sleeps until it is answered or leads.
  void follow(Waiter& waiter) { waiter.next = std::exchange(followers_, &waiter); }
  /// Ends follow(). False when it follows no longer: it has been, or is being, woken.
  bool unfollow(Waiter& waiter);
  /// The lease goes from the calling thread to the follower that has waited longest, which is to be
  /// woken there. Null when nobody follows.
  const SleepWord* pass_on();
  /// Whether this thread is to look for a leader; it has to, then.
  bool begin_search() { return lacks_reader_.exchange(false) && !is_taken_; }
  /// The waiter is done. True when it sleeps: the caller of this wakes it after the lock.
  bool finish(Waiter& waiter);
  /// With the lease: the waiter is done when wake_answered() is called, or at once if it does not
  /// sleep.
  void finish_after_receive(Waiter& waiter);

  /// With the lease, without the lock: the calling thread leads, so that it needs no wake-up.
  static void finish_leader(Waiter& waiter) {
    waiter.state.fetch_or(Waiter::done, std::memory_order_release);
  }
  /// With the lease, without the lock: wakes those of finish_after_receive().
  void wake_answered();
  /// Without the lock, by a follower that was woken with its answer. True when it has to call
  /// begin_search().
  bool pass_answered() {
    passing_.fetch_sub(1);
    return lacks_reader_;
  }
  /// Without the lock, by the leader that has given the lease back: whether it has to search
  /// itself, because none of those that it has woken will.
  [[nodiscard]] bool must_search() const { return lacks_reader_ && passing_ == 0; }

  /// Callers that were woken and may call again; an estimate. Any thread.
  [[nodiscard]] const Atomic<unsigned>& expected_callers() const { return expected_; }
  /// A caller calls. True when others are expected. Those that never call again are forgotten, one
  /// for each call. Any thread.
  bool arrive();

  /// How often a caller has got the lease, or a pinned thread has kept it. By whoever has the lease
  /// or the lock.
  [[nodiscard]] std::uint32_t uses() const { return uses_; }
  void count_use() { ++uses_; }

 private:
  using Link = typename Waiter::Link;

  Plain<bool> is_taken_ = false;
  Plain<bool> is_asked_again_ = false;
  Plain<bool> has_woken_ = false;  // with the lease: the leader has woken others
  Plain<std::uint32_t> uses_ = 0;
  Atomic<bool> lacks_reader_{false};  // written under the lock
  Atomic<unsigned> passing_{0};       // followers that have been answered and have not run
  Atomic<unsigned> expected_{0};
  Link followers_ = nullptr;
  Link answered_ = nullptr;  // with the lease: followers to be woken
  Plain<Link*> answered_end_ = &answered_;
};

template <class Sync>
void BasicReadLease<Sync>::lead(Waiter& waiter) {
  is_taken_ = true;
  lacks_reader_ = false;
  waiter.state.fetch_or(Waiter::reader, std::memory_order_relaxed);
  ++uses_;
}

template <class Sync>
void BasicReadLease<Sync>::end_lead(Waiter& waiter) {
  waiter.state.fetch_and(~Waiter::reader, std::memory_order_relaxed);
  // It comes again with those that it has woken.
  if (std::exchange(has_woken_, false)) expected_.fetch_add(1, std::memory_order_relaxed);
}

template <class Sync>
bool BasicReadLease<Sync>::give_back_by_leader() {
  is_taken_ = false;
  lacks_reader_ = followers_ != nullptr;
  return followers_ == nullptr;
}

template <class Sync>
bool BasicReadLease<Sync>::unfollow(Waiter& waiter) {
  for (Link* link = &followers_; *link != nullptr; link = &(*link)->next) {
    if (*link != &waiter) continue;
    *link = std::exchange(waiter.next, nullptr);
    return true;
  }
  return false;
}

template <class Sync>
const typename Sync::SleepWord* BasicReadLease<Sync>::pass_on() {
  if (followers_ == nullptr) return nullptr;
  Waiter* oldest = followers_;
  while (oldest->next != nullptr) oldest = oldest->next;
  unfollow(*oldest);
  oldest->state.fetch_or(Waiter::reader, std::memory_order_release);
  is_taken_ = true;
  return &oldest->state;
}

template <class Sync>
bool BasicReadLease<Sync>::finish(Waiter& waiter) {
  const bool is_asleep = unfollow(waiter);
  waiter.state.fetch_or(Waiter::done, std::memory_order_release);
  if (is_asleep) expected_.fetch_add(1, std::memory_order_relaxed);
  return is_asleep;
}

template <class Sync>
void BasicReadLease<Sync>::finish_after_receive(Waiter& waiter) {
  if (unfollow(waiter)) {
    waiter.state.fetch_or(Waiter::answered, std::memory_order_relaxed);
    *answered_end_ = &waiter;
    answered_end_ = &waiter.next;
  } else {
    waiter.state.fetch_or(Waiter::done, std::memory_order_release);
  }
}

template <class Sync>
void BasicReadLease<Sync>::wake_answered() {
  if (answered_ == nullptr) return;
  Waiter* waiter = std::exchange(answered_, nullptr);
  answered_end_ = &answered_;
  has_woken_ = true;
  unsigned count = 0;
  for (const Waiter* each = waiter; each != nullptr; each = each->next) ++count;
  expected_.fetch_add(count, std::memory_order_relaxed);
  passing_.fetch_add(count);
  while (waiter != nullptr) {
    Waiter* const next = waiter->next;
    waiter->state.fetch_or(Waiter::done, std::memory_order_release);  // it may be gone now
    Sync::wake(&waiter->state);
    waiter = next;
  }
}

template <class Sync>
bool BasicReadLease<Sync>::arrive() {
  unsigned expected = expected_.load(std::memory_order_relaxed);
  while (expected != 0 &&
         !expected_.compare_exchange_weak(expected, expected - 1, std::memory_order_relaxed)) {
  }
  return expected != 0;
}

using ReadLease = BasicReadLease<Synchronization>;
extern template class BasicReadLease<Synchronization>;  // read_lease.cpp

}  // namespace rr::channel
