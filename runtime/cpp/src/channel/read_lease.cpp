// SPDX-License-Identifier: Apache-2.0
#include "runtime/cpp/src/channel/read_lease.hpp"

namespace rr::channel {

void ReadLease::lead(Waiter& waiter) {
  is_taken_ = true;
  lacks_reader_ = false;
  waiter.state.fetch_or(Waiter::reader, std::memory_order_relaxed);
  ++uses_;
}

void ReadLease::end_lead(Waiter& waiter) {
  waiter.state.fetch_and(~Waiter::reader, std::memory_order_relaxed);
  // It comes again with those that it has woken.
  if (std::exchange(has_woken_, false)) expected_.fetch_add(1, std::memory_order_relaxed);
}

bool ReadLease::give_back_by_leader() {
  is_taken_ = false;
  lacks_reader_ = followers_ != nullptr;
  return followers_ == nullptr;
}

bool ReadLease::unfollow(Waiter& waiter) {
  for (Waiter** link = &followers_; *link != nullptr; link = &(*link)->next) {
    if (*link != &waiter) continue;
    *link = std::exchange(waiter.next, nullptr);
    return true;
  }
  return false;
}

const platform::SleepWord* ReadLease::pass_on() {
  if (followers_ == nullptr) return nullptr;
  Waiter* oldest = followers_;
  while (oldest->next != nullptr) oldest = oldest->next;
  unfollow(*oldest);
  oldest->state.fetch_or(Waiter::reader, std::memory_order_release);
  is_taken_ = true;
  return &oldest->state;
}

bool ReadLease::finish(Waiter& waiter) {
  const bool is_asleep = unfollow(waiter);
  waiter.state.fetch_or(Waiter::done, std::memory_order_release);
  if (is_asleep) expected_.fetch_add(1, std::memory_order_relaxed);
  return is_asleep;
}

void ReadLease::finish_after_receive(Waiter& waiter) {
  if (unfollow(waiter)) {
    waiter.state.fetch_or(Waiter::answered, std::memory_order_relaxed);
    *answered_end_ = &waiter;
    answered_end_ = &waiter.next;
  } else {
    waiter.state.fetch_or(Waiter::done, std::memory_order_release);
  }
}

void ReadLease::wake_answered() {
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
    platform::wake(&waiter->state);
    waiter = next;
  }
}

bool ReadLease::arrive() {
  unsigned expected = expected_.load(std::memory_order_relaxed);
  while (expected != 0 &&
         !expected_.compare_exchange_weak(expected, expected - 1, std::memory_order_relaxed)) {
  }
  return expected != 0;
}

}  // namespace rr::channel
