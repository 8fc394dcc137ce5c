// SPDX-License-Identifier: Apache-2.0
#include "runtime/cpp/src/channel/reactor.hpp"

#include <algorithm>
#include <system_error>
#include <utility>

#include "runtime/cpp/src/channel/reactor_polling.hpp"

namespace rr::channel {
namespace {

// How often the polling thread is looked at while it is active; in how many looks it must be found
// in the same handler before another thread takes over; after how many looks without anything new
// the watching thread sleeps.
constexpr std::chrono::microseconds look_period{2500};
constexpr int looks_until_stuck = 2;
constexpr int looks_until_quiet = 10;
// Of so many threads one is kept for sessions that hold none.
constexpr unsigned threads_for_one_in_reserve = 8;

}  // namespace

constinit thread_local Reactor::Polling* Reactor::current_polling = nullptr;
constinit thread_local const Reactor* Reactor::current_reactor = nullptr;

Reactor::Reactor(Terms terms)
    : terms_(std::move(terms)),
      max_threads_(std::max(terms_.max_threads, duties)),
      max_stays_(std::min(std::max(std::thread::hardware_concurrency(), 1U), max_threads_ / 4)),
      reserve_(max_threads_ / threads_for_one_in_reserve) {}

Reactor::~Reactor() { stop(); }

void Reactor::start() {
  const MutexLock lock(mutex_);
  if (is_stopping_) return;
  while (live_threads_ < duties) {
    if (!add_thread()) {
      throw std::system_error(std::make_error_code(std::errc::resource_unavailable_try_again),
                              "the node's threads");
    }
  }
}

void Reactor::stop() {
  flusher_.stop();
  std::list<std::thread> threads;
  // What is posted for a connection may keep it alive. It goes without the lock, which its
  // destructor takes.
  std::deque<Posted> posted;
  std::deque<Posted> waiting;
  {
    const MutexLock lock(mutex_);
    is_stopping_ = true;
    is_stay_over_ = true;
    threads.swap(threads_);
    ended_.clear();
    posted.swap(posted_);
    waiting.swap(waiting_);
    for (std::deque<Posted>* const queue : {&posted, &waiting}) {
      for (Posted& each : *queue) late_.add(std::move(each.work));
    }
  }
  idle_.notify_all();
  watch_.notify_all();
  wake_polling_thread();
  for (std::thread& thread : threads) thread.join();
  late_.wait();
  RetiredPollables::Pollables retired;  // go without the lock
  const MutexLock lock(mutex_);
  retired = retired_.end();
}

bool Reactor::is_stopping() const {
  const MutexLock lock(mutex_);
  return is_stopping_;
}

bool Reactor::is_own_thread() const { return current_reactor == this || late_.is_own_thread(); }

void Reactor::add(int socket, std::uint32_t events, Pollable& pollable) {
  sockets_.add(socket, events, &pollable);
}

void Reactor::change(int socket, std::uint32_t events, Pollable& pollable) {
  sockets_.change(socket, events, &pollable);
}

void Reactor::remove(int socket) { sockets_.remove(socket); }

void Reactor::retire(std::shared_ptr<Pollable> pollable) {
  {
    const MutexLock lock(mutex_);
    if (!retired_.add(std::move(pollable))) return;
    has_work_.store(true, std::memory_order_release);
  }
  wake_polling_thread();
}

void Reactor::post(Posted posted) {
  {
    const MutexLock lock(mutex_);
    if (is_stopping_) {
      late_.add(std::move(posted.work));
      return;
    }
    posted_.push_back(std::move(posted));
    has_work_.store(true, std::memory_order_release);
  }
  wake_polling_thread();
}

void Reactor::wake_polling_thread() { sockets_.wake(); }

void Reactor::wake_watching_thread() {
  const MutexLock lock(mutex_);
  turn_.wake_watcher(watch_);
}

// Polling

void Reactor::poll(Polling& polling) {
  current_polling = &polling;
  Time yield_at = Time::min();  // while there is always something posted
  while (handle_events(polling)) {
    if (has_work_.load(std::memory_order_acquire) && !run_posted(polling)) break;
    if (is_stopping_.load(std::memory_order_acquire)) break;
    if (!events_.empty()) continue;  // find_others() has found some meanwhile
    const bool must_go_on = has_work_.load(std::memory_order_acquire);
    if (must_go_on) yield_processor(yield_at);
    events_.fetch([&](auto room) { return sockets_.wait(room, !must_go_on); });
  }
  current_polling = nullptr;
}

// Whoever takes the turn away does so between these two only, and from the handler that it saw.
void Reactor::enter(Polling& polling, Pollable* pollable) {
  handling_ = pollable;
  polling.yield_at = Time::min();
  if (turn_.enter(polling.turn)) wake_watching_thread();
}

// False when the turn has been lost meanwhile, here and below.
bool Reactor::leave(Polling& polling) { return turn_.leave(polling.turn); }

bool Reactor::handle_events(Polling& polling) {
  while (!events_.empty()) {
    const ReadyEvents::Event& event = events_.take();
    if (event.key == nullptr) continue;  // a wake-up
    auto* const pollable = static_cast<Pollable*>(event.key);
    const std::uint32_t events = event.events;
    enter(polling, pollable);
    pollable->on_ready(events);
    if (!leave(polling)) return false;
  }
  return true;
}

bool Reactor::holds_up_others() {
  Polling* const polling = current_polling;
  if (polling == nullptr || polling->reactor != this || !is_inside(*polling)) return false;
  Pollable* const own = handling_;
  if (!leave(*polling)) return false;  // nobody takes the turn away while events are fetched
  const bool is_found = find_others(own);
  enter(*polling, own);
  return is_found;
}

bool Reactor::is_posted_for_others(const Pollable* own) const {
  const MutexLock lock(mutex_);
  return std::any_of(posted_.begin(), posted_.end(), [&](const Posted& posted) {
    return posted.pollable == nullptr || posted.pollable.get() != own;
  });
}

// Adds what is ready by now to the events that are still to be handled. One for `own`, which may
// get more and more, is kept once.
bool Reactor::find_others(const Pollable* own) {
  if (has_work_.load(std::memory_order_acquire) && is_posted_for_others(own)) return true;
  return events_.find_others(own, [&](auto room) { return sockets_.wait(room, false); });
}

// One at a time, then it is polled: connections that always have more to read post that again and
// again, and whoever has little to say need not wait for all of them.
bool Reactor::run_posted(Polling& polling) {
  take_retired().clear();
  Posted next;
  Handling admission{};
  if (!next_posted(next, admission)) return true;
  polling.posted_for = std::move(next.share);
  enter(polling, next.pollable.get());
  if (admission == Handling::aside) give_way();
  run(next.work);
  next.work = nullptr;
  if (!leave(polling)) return false;
  polling.posted_for = nullptr;
  return true;
}

// No event is left that could name them. A thread that has lost its turn may still be about to
// enter the handler of one.
RetiredPollables::Pollables Reactor::take_retired() {
  const MutexLock lock(mutex_);
  has_work_.store(false, std::memory_order_relaxed);
  return retired_.take();
}

// What throws here is code of the program that nobody guards: the node goes on.
void Reactor::run(const std::function<void()>& work) const {
  try {
    work();
  } catch (const std::exception& error) {
    if (terms_.report) terms_.report(std::string("work of the node has thrown: ") + error.what());
  } catch (...) {
    if (terms_.report) terms_.report("work of the node has thrown something that is no exception");
  }
}

// False when there is none that may run now.
bool Reactor::next_posted(Posted& next, Handling& admission) {
  const MutexLock lock(mutex_);
  while (!posted_.empty()) {
    next = std::move(posted_.front());
    posted_.pop_front();
    admission = next.share ? admit(*next.share) : Handling::in_place;
    if (admission != Handling::later) {
      if (!posted_.empty()) has_work_.store(true, std::memory_order_release);
      return true;
    }
    waiting_.push_back(std::move(next));
    call_back_stays();
  }
  return false;
}

[[gnu::hot]] void Reactor::about_to_wait() {
  Polling* const polling = current_polling;
  if (polling == nullptr) return;
  Reactor& reactor = *polling->reactor;
  Pollable* handling = nullptr;
  {
    const MutexLock lock(reactor.mutex_);
    const bool is_handed_over = reactor.hand_over(*polling, true);
    if (is_handed_over) handling = reactor.handling_;  // nobody else's yet
    reactor.report_missing_thread();
    if (!is_handed_over) return;
  }
  if (handling != nullptr) handling->on_stuck();
}

void Reactor::give_way() {
  Polling* const polling = current_polling;
  if (polling == nullptr) return;
  Reactor& reactor = *polling->reactor;
  const MutexLock lock(reactor.mutex_);
  reactor.hand_over(*polling, true);
  reactor.report_missing_thread();
}

// Others come first where one processor is for all, who wait for an answer of this thread, too.
void Reactor::yield_processor(Time& at) {
  const Time now = Clock::now();
  if (now < at) return;
  at = now + longest_slice;
  std::this_thread::yield();
}

void Reactor::yield() {
  thread_local Time yield_at = Time::min();
  Polling* const polling = current_polling;
  if (polling == nullptr || !polling->reactor->is_inside(*polling)) {
    yield_processor(yield_at);
    return;
  }
  const Time now = Clock::now();
  if (polling->yield_at == Time::min()) {
    polling->yield_at = now + longest_turn;
  } else if (now >= polling->yield_at) {
    polling->yield_at = now + longest_turn;
    give_way();
  }
}

bool Reactor::is_polling() const {
  const Polling* const polling = current_polling;
  return polling != nullptr && polling->reactor == this && turn_.is_of(polling->turn);
}

// Whether the thread has the turn, and is in a handler.
bool Reactor::is_inside(const Polling& polling) const { return turn_.is_inside(polling.turn); }

// Gives up the turn to poll, for the next thread that is free. False when the caller keeps it, or
// has lost it already.
bool Reactor::hand_over(Polling& polling, bool is_held) {
  if (!is_inside(polling) || !secure_thread()) return false;
  if (!turn_.take(polling.turn)) return false;
  is_polled_ = false;
  note_loss(polling);
  if (is_held) hold(polling);
  return true;
}

bool Reactor::begin_stay() {
  Polling* const polling = current_polling;
  if (polling == nullptr || polling->reactor != this) return false;
  const MutexLock lock(mutex_);
  if (stays_ >= max_stays_ || is_stay_over_ || is_tight_) return false;
  if (!is_inside(*polling) || events_.size() > 1) return false;
  if (!hand_over(*polling, false)) return false;
  ++stays_;
  return true;
}

void Reactor::end_stay() {
  const MutexLock lock(mutex_);
  if (--stays_ == 0) is_stay_over_ = is_stopping_.load();
}

unsigned Reactor::stays() const {
  const MutexLock lock(mutex_);
  return stays_;
}

unsigned Reactor::held() const {
  const MutexLock lock(mutex_);
  return held_;
}

unsigned Reactor::live_threads() const {
  const MutexLock lock(mutex_);
  return live_threads_;
}

std::size_t Reactor::waiting() const {
  const MutexLock lock(mutex_);
  return waiting_.size();
}

// Watching

// Returns true when this thread is to poll from now on.
[[gnu::hot]] bool Reactor::watch() {
  TurnLooks looks(turn_.look(), looks_until_stuck, looks_until_quiet);
  while (!is_stopping_) {
    report_missing_thread();
    const Time next_timer = run_timers();
    if (is_stopping_) break;  // since the lock was given up
    const std::uint64_t turn = turn_.look();
    looks.note(turn);
    if (looks.is_stuck() && take_over(turn)) {
      is_watched_ = false;
      Pollable* const stuck = handling_;
      const MutexUnlock unlock(mutex_);
      if (stuck != nullptr) stuck->on_stuck();
      return true;
    }
    turn_.watch(watch_, mutex_, turn, looks.is_quiet(), Clock::now() + look_period, next_timer);
  }
  is_watched_ = false;
  return false;
}

// Not when nobody would watch then: timers would stand still, too.
bool Reactor::take_over(std::uint64_t turn) {
  if (!secure_thread()) return false;
  if (!turn_.take(turn)) return false;
  note_loss(*poller_);
  hold(*poller_);
  if (poller_->held_by) poller_->held_by->note_stall(coarse_now());
  return true;
}

// Timers

[[gnu::hot]] void Reactor::schedule(Timer& timer, std::weak_ptr<void> owner, Time when) {
  const MutexLock lock(mutex_);
  const bool is_first = timers_.schedule(timer, std::move(owner), is_stopping_ ? never : when);
  if (is_first) watch_.notify_one();
}

void Reactor::cancel(Timer& timer) {
  const MutexLock lock(mutex_);
  timers_.cancel(timer);
}

// Returns when the next one is due.
[[gnu::hot]] Time Reactor::run_timers() {
  Time next = timers_.next_due();
  while (next != never && next <= Clock::now()) {
    {
      TimerHeap::Due due = timers_.take_first();
      const MutexUnlock unlock(mutex_);
      due.run();
    }
    next = timers_.next_due();
  }
  return next;
}

}  // namespace rr::channel
