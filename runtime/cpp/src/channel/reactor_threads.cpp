// SPDX-License-Identifier: Apache-2.0
// The threads of a reactor: how they are made and end, and who may hold them.
#include <algorithm>
#include <chrono>
#include <system_error>
#include <utility>

#include "runtime/cpp/src/channel/reactor.hpp"
#include "runtime/cpp/src/channel/reactor_polling.hpp"
#include "runtime/cpp/src/platform/threads.hpp"

namespace rr::channel {
namespace {

// A thread without a duty ends after this time.
constexpr std::chrono::seconds idle_time{2};
// When no thread could be made it is tried again after this time.
constexpr std::chrono::seconds thread_retry{1};

}  // namespace

// False when there can be none: the system, or its administrator, limits them.
bool Reactor::add_thread() {
  reap();
  try {
    threads_.push_back(terms_.make_thread ? terms_.make_thread([this] { run_thread(); })
                                          : std::thread([this] { run_thread(); }));
  } catch (const std::system_error&) {
    must_report_ = must_report_ || no_thread_until_ == Time::min();
    no_thread_until_ = Clock::now() + thread_retry;
    return false;
  }
  ++live_threads_;
  no_thread_until_ = Time::min();
  note_free();
  return true;
}

// Sees to it that somebody takes up a duty that the caller is about to leave. False when there is
// nobody, and the caller must keep it.
bool Reactor::secure_thread() {
  if (is_stopping_) return false;
  if (idle_threads_ > wanted_threads_) {
    ++wanted_threads_;
    idle_.notify_one();
    note_free();
    return true;
  }
  const bool may_add = live_threads_ < max_threads_ && Clock::now() >= no_thread_until_;
  if (may_add && add_thread()) return true;
  call_back_stays();
  return false;
}

void Reactor::call_back_stays() {
  if (stays_ != 0) is_stay_over_ = true;
}

// The lock is given up meanwhile.
void Reactor::report_missing_thread() {
  if (!std::exchange(must_report_, false) || !terms_.report) return;
  const MutexUnlock unlock(mutex_);
  terms_.report("no thread can be made for a handler that takes long: it holds up others");
}

// Threads that could take up another duty.
unsigned Reactor::free_threads() const {
  const unsigned idle = idle_threads_ > wanted_threads_ ? idle_threads_ - wanted_threads_ : 0;
  return idle + (max_threads_ > live_threads_ ? max_threads_ - live_threads_ : 0);
}

void Reactor::note_free() {
  is_tight_.store(free_threads() <= reserve_, std::memory_order_relaxed);
}

// Joins threads that have ended.
void Reactor::reap() {
  for (const std::thread::id id : ended_) {
    const auto found = std::find_if(threads_.begin(), threads_.end(),
                                    [id](const std::thread& t) { return t.get_id() == id; });
    if (found == threads_.end()) continue;
    found->join();
    threads_.erase(found);
  }
  ended_.clear();
}

void Reactor::run_thread() {
  current_reactor = this;
  platform::ask_for_short_slices();
  const MutexLock lock(mutex_);
  while (!is_stopping_) {
    if (!is_polled_) {
      poll_until_lost();
    } else if (!is_watched_) {
      is_watched_ = true;
      if (watch()) poll_until_lost();
    } else {
      ++idle_threads_;
      note_free();
      move_waiting();
      const Time until = Clock::now() + idle_time;
      while (wanted_threads_ == 0 && !is_stopping_ && Clock::now() < until) {
        wait_until(idle_, mutex_, until);
      }
      --idle_threads_;
      if (wanted_threads_ != 0) {
        --wanted_threads_;
      } else if (is_polled_ && is_watched_) {
        break;
      }
      note_free();
    }
  }
  --live_threads_;
  note_free();
  if (!is_stopping_) ended_.push_back(std::this_thread::get_id());
}

// Takes the turn to poll, which nobody else has.
void Reactor::poll_until_lost() {
  is_polled_ = true;
  Polling polling{.reactor = this, .turn = turn_.begin()};
  poller_ = &polling;
  {
    const MutexUnlock unlock(mutex_);
    poll(polling);
  }
  release(polling);
}

// Shares of threads

// The thread of `polling` has lost its turn in a handler.
void Reactor::note_loss(Polling& polling) {
  polling.inside = handling_;
  if (polling.inside != nullptr) retired_.enter(polling.inside);
}

// It will be there for a while.
void Reactor::hold(Polling& polling) {
  std::shared_ptr<ThreadShare> share =
      handling_ != nullptr ? handling_->thread_share() : polling.posted_for;
  if (share) share->hold();
  polling.held_by = std::move(share);
  polling.is_held = true;
  ++held_;
}

void Reactor::release(Polling& polling) {
  if (polling.inside != nullptr) {
    retired_.leave(polling.inside);
    if (!retired_.empty()) {
      has_work_.store(true, std::memory_order_release);
      wake_polling_thread();
    }
  }
  if (polling.is_held) {
    --held_;
    if (polling.held_by) polling.held_by->release();
  }
  move_waiting();
}

Handling Reactor::admit(const ThreadShare& share) const {
  if (share.has_departed()) return Handling::in_place;
  return channel::admit({.free = free_threads(),
                         .reserve = reserve_,
                         .most = max_threads_ - duties,
                         .held = held_,
                         .held_by_address = share.held_by_address(),
                         .held_by_session = share.held(),
                         .session_limit = terms_.session_threads},
                        share.pace());
}

// A thread that does not poll holds up nobody: it is held already, or stays.
Handling Reactor::look_up(const ThreadShare& share) {
  if (!is_polling()) return Handling::in_place;
  const MutexLock lock(mutex_);
  return is_stopping_ ? Handling::in_place : admit(share);
}

// What may go on does; it is looked at once more when its turn has come.
void Reactor::move_waiting() {
  if (waiting_.empty()) return;
  std::deque<Posted> still;
  for (Posted& posted : waiting_) {
    const bool must_wait = admit(*posted.share) == Handling::later;
    (must_wait ? still : posted_).push_back(std::move(posted));
  }
  waiting_.swap(still);
  if (posted_.empty()) return;
  has_work_.store(true, std::memory_order_release);
  wake_polling_thread();
}

void Reactor::reconsider() {
  const MutexLock lock(mutex_);
  move_waiting();
}

std::shared_ptr<ThreadShare> Reactor::open_share(const std::string& key) {
  const MutexLock lock(mutex_);
  return std::make_shared<ThreadShare>(addresses_.open(key));
}

}  // namespace rr::channel
