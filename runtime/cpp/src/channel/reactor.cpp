// SPDX-License-Identifier: Apache-2.0
#include "runtime/cpp/src/channel/reactor.hpp"

#include <sys/epoll.h>
#include <sys/eventfd.h>
#include <unistd.h>

#include <algorithm>
#include <cerrno>
#include <system_error>
#include <utility>

namespace rr::channel {
namespace {

// How often the polling thread is looked at while it is active; in how many looks it must be found
// in the same handler before another thread takes over; after how many looks without anything new
// the watching thread sleeps.
constexpr std::chrono::microseconds look_period{2500};
constexpr int looks_until_stuck = 2;
constexpr int looks_until_quiet = 10;
// A thread without a duty ends after this time.
constexpr std::chrono::seconds idle_time{10};

[[noreturn]] void fail(const char* what) {
  throw std::system_error(errno, std::generic_category(), what);
}

}  // namespace

struct Reactor::Polling {
  Reactor* reactor;
  std::uint64_t turn;
};

thread_local Reactor::Polling* Reactor::current_polling = nullptr;
thread_local const Reactor* Reactor::current_reactor = nullptr;

Reactor::Reactor(unsigned max_threads)
    : max_threads_(std::max(max_threads, 2U)),
      max_stays_(std::min(std::max(std::thread::hardware_concurrency(), 1U), max_threads_ / 4)),
      events_(std::make_unique<epoll_event[]>(events_at_once)) {
  epoll_ = epoll_create1(EPOLL_CLOEXEC);
  if (epoll_ < 0) fail("epoll_create1");
  wake_ = eventfd(0, EFD_CLOEXEC | EFD_NONBLOCK);
  epoll_event event{};
  event.events = EPOLLIN | EPOLLET;
  if (wake_ < 0 || epoll_ctl(epoll_, EPOLL_CTL_ADD, wake_, &event) != 0) {
    const int error = errno;
    if (wake_ >= 0) ::close(wake_);
    ::close(epoll_);
    errno = error;
    fail("eventfd");
  }
}

Reactor::~Reactor() {
  stop();
  ::close(wake_);
  ::close(epoll_);
}

void Reactor::start() {
  const std::lock_guard lock(mutex_);
  if (is_stopping_ || !threads_.empty()) return;
  add_thread();
  add_thread();
}

void Reactor::stop() {
  flusher_.stop();
  std::list<std::thread> threads;
  {
    const std::lock_guard lock(mutex_);
    is_stopping_ = true;
    is_stay_over_ = true;
    threads.swap(threads_);
    ended_.clear();
    for (std::function<void()>& work : posted_) late_.add(std::move(work));
    posted_.clear();
  }
  idle_.notify_all();
  watch_.notify_all();
  wake_polling_thread();
  for (std::thread& thread : threads) thread.join();
  late_.wait();
  std::vector<std::shared_ptr<void>> retired;
  const std::lock_guard lock(mutex_);
  has_ended_ = true;
  retired.swap(retired_);
}

bool Reactor::is_own_thread() const { return current_reactor == this || late_.is_own_thread(); }

void Reactor::add(int descriptor, std::uint32_t events, Pollable& pollable) {
  epoll_event event{};
  event.events = events | EPOLLET;
  event.data.ptr = &pollable;
  if (epoll_ctl(epoll_, EPOLL_CTL_ADD, descriptor, &event) != 0) fail("epoll_ctl");
}

void Reactor::change(int descriptor, std::uint32_t events, Pollable& pollable) {
  epoll_event event{};
  event.events = events | EPOLLET;
  event.data.ptr = &pollable;
  if (epoll_ctl(epoll_, EPOLL_CTL_MOD, descriptor, &event) != 0) fail("epoll_ctl");
}

void Reactor::remove(int descriptor) {
  epoll_event event{};
  epoll_ctl(epoll_, EPOLL_CTL_DEL, descriptor, &event);
}

void Reactor::retire(std::shared_ptr<void> pollable) {
  {
    const std::lock_guard lock(mutex_);
    if (has_ended_) return;
    retired_.push_back(std::move(pollable));
    has_work_.store(true, std::memory_order_release);
  }
  wake_polling_thread();
}

void Reactor::post(std::function<void()> work) {
  {
    const std::lock_guard lock(mutex_);
    if (is_stopping_) {
      late_.add(std::move(work));
      return;
    }
    posted_.push_back(std::move(work));
    has_work_.store(true, std::memory_order_release);
  }
  wake_polling_thread();
}

void Reactor::begin_connection() {
  const std::lock_guard lock(mutex_);
  ++connections_;
}

void Reactor::end_connection() {
  const std::lock_guard lock(mutex_);
  if (--connections_ == 0) no_connection_.notify_all();
}

void Reactor::wait_for_connections() {
  std::unique_lock lock(mutex_);
  no_connection_.wait(lock, [&] { return connections_ == 0; });
}

void Reactor::wake_polling_thread() {
  const std::uint64_t one = 1;
  // Can fail only when the counter is full, and then there is an event already.
  [[maybe_unused]] const ssize_t written = ::write(wake_, &one, sizeof one);
}

void Reactor::wake_watching_thread() {
  // The lock makes sure that the thread is really waiting.
  const std::lock_guard lock(mutex_);
  watching_thread_sleeps_.store(false, std::memory_order_relaxed);
  watch_.notify_one();
}

// Threads

void Reactor::add_thread() {
  reap();
  threads_.emplace_back([this] { run_thread(); });
  ++live_threads_;
}

// Sees to it that somebody takes up a duty that nobody has now.
void Reactor::need_thread() {
  if (is_stopping_) return;
  if (idle_threads_ > wanted_threads_) {
    ++wanted_threads_;
    idle_.notify_one();
  } else if (live_threads_ < max_threads_) {
    add_thread();
  } else {
    is_stay_over_ = stays_ != 0;
  }
}

// Whether there is, or can be, one for another duty. If not, those that stay are called back.
bool Reactor::has_spare_thread() {
  if (idle_threads_ > wanted_threads_ || live_threads_ < max_threads_) return true;
  if (stays_ != 0) is_stay_over_ = true;
  return false;
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
  std::unique_lock lock(mutex_);
  while (!is_stopping_) {
    if (!is_polled_) {
      is_polled_ = true;
      const std::uint64_t turn = turn_.load(std::memory_order_relaxed) / 2;
      lock.unlock();
      poll(turn);
      lock.lock();
    } else if (!is_watched_) {
      is_watched_ = true;
      if (watch(lock)) {
        const std::uint64_t turn = turn_.load(std::memory_order_relaxed) / 2;
        lock.unlock();
        poll(turn);
        lock.lock();
      }
    } else {
      ++idle_threads_;
      const Time until = Clock::now() + idle_time;
      while (wanted_threads_ == 0 && !is_stopping_ && Clock::now() < until) {
        wait_until(idle_, lock, until);
      }
      --idle_threads_;
      if (wanted_threads_ != 0) {
        --wanted_threads_;
      } else if (is_polled_ && is_watched_) {
        break;
      }
    }
  }
  --live_threads_;
  if (!is_stopping_) ended_.push_back(std::this_thread::get_id());
}

// Polling

void Reactor::poll(std::uint64_t turn) {
  Polling polling{this, turn};
  current_polling = &polling;
  while (handle_events(polling)) {
    if (has_work_.load(std::memory_order_acquire) && !run_posted(polling)) break;
    if (is_stopping_.load(std::memory_order_acquire)) break;
    const int found = epoll_wait(epoll_, events_.get(), events_at_once, -1);
    event_count_ = found > 0 ? static_cast<std::size_t>(found) : 0;
    next_event_ = 0;
  }
  current_polling = nullptr;
}

// Whoever takes the turn away does so between these two only.
void Reactor::enter(const Polling& polling, Pollable* pollable) {
  handling_ = pollable;
  turn_.store(polling.turn * 2 + 1, std::memory_order_release);
  handled_.fetch_add(1);
  if (watching_thread_sleeps_.load()) wake_watching_thread();
}

// False when the turn has been lost meanwhile, here and below.
bool Reactor::leave(const Polling& polling) {
  std::uint64_t expected = polling.turn * 2 + 1;
  return turn_.compare_exchange_strong(expected, polling.turn * 2);
}

bool Reactor::handle_events(const Polling& polling) {
  while (next_event_ != event_count_) {
    const epoll_event& event = events_[next_event_++];
    if (event.data.ptr == nullptr) continue;  // a wake-up; edge-triggered, so it need not be read
    auto* const pollable = static_cast<Pollable*>(event.data.ptr);
    const std::uint32_t events = event.events;
    enter(polling, pollable);
    pollable->on_ready(events);
    if (!leave(polling)) return false;
  }
  return true;
}

bool Reactor::run_posted(const Polling& polling) {
  std::vector<std::shared_ptr<void>> retired;
  {
    const std::lock_guard lock(mutex_);
    has_work_.store(false, std::memory_order_relaxed);
    retired.swap(retired_);  // no event is left that could name them
  }
  retired.clear();
  while (true) {
    std::function<void()> work;
    {
      const std::lock_guard lock(mutex_);
      if (posted_.empty()) return true;
      work = std::move(posted_.front());
      posted_.pop_front();
      if (!posted_.empty()) has_work_.store(true, std::memory_order_release);
    }
    enter(polling, nullptr);
    work();
    work = nullptr;
    if (!leave(polling)) return false;
  }
}

void Reactor::about_to_wait() {
  Polling* const polling = current_polling;
  if (polling == nullptr) return;
  Reactor& reactor = *polling->reactor;
  Pollable* handling = nullptr;
  {
    const std::lock_guard lock(reactor.mutex_);
    if (!reactor.hand_over(*polling)) return;
    handling = reactor.handling_;  // nobody else's yet
    reactor.need_thread();
  }
  if (handling != nullptr) handling->on_stuck();
}

// Gives up the turn to poll, for the next thread that is free.
bool Reactor::hand_over(const Polling& polling) {
  if (is_stopping_ || !has_spare_thread()) return false;
  std::uint64_t expected = polling.turn * 2 + 1;
  if (!turn_.compare_exchange_strong(expected, (polling.turn + 1) * 2)) return false;
  is_polled_ = false;
  return true;
}

bool Reactor::begin_stay() {
  const Polling* const polling = current_polling;
  if (polling == nullptr || polling->reactor != this) return false;
  const std::lock_guard lock(mutex_);
  if (stays_ >= max_stays_ || is_stay_over_) return false;
  if (turn_.load() != polling->turn * 2 + 1 || event_count_ > 1) return false;
  if (!hand_over(*polling)) return false;
  ++stays_;
  need_thread();
  return true;
}

void Reactor::end_stay() {
  const std::lock_guard lock(mutex_);
  if (--stays_ == 0) is_stay_over_ = is_stopping_.load();
}

unsigned Reactor::stays() const {
  const std::lock_guard lock(mutex_);
  return stays_;
}

// Watching

// Returns true when this thread is to poll from now on.
bool Reactor::watch(std::unique_lock<std::mutex>& lock) {
  std::uint64_t handled = handled_.load();
  int stuck_looks = 0;
  int quiet_looks = 0;
  while (!is_stopping_) {
    const Time next_timer = run_timers(lock);
    const std::uint64_t turn = turn_.load();
    const std::uint64_t now_handled = handled_.load();
    const bool is_busy = turn % 2 != 0;
    stuck_looks = is_busy && now_handled == handled ? stuck_looks + 1 : 0;
    quiet_looks = !is_busy && now_handled == handled ? quiet_looks + 1 : 0;
    handled = now_handled;
    if (stuck_looks >= looks_until_stuck && take_over(turn)) {
      is_watched_ = false;
      need_thread();
      Pollable* const stuck = handling_;
      lock.unlock();
      if (stuck != nullptr) stuck->on_stuck();
      lock.lock();
      return true;
    }
    Time until = std::min(next_timer, Clock::now() + look_period);
    if (quiet_looks >= looks_until_quiet) {
      watching_thread_sleeps_.store(true);
      if (handled_.load() == handled) until = next_timer;
    }
    wait_until(watch_, lock, until);
    watching_thread_sleeps_.store(false, std::memory_order_relaxed);
  }
  is_watched_ = false;
  return false;
}

bool Reactor::take_over(std::uint64_t turn) {
  if (!has_spare_thread()) return false;
  return turn_.compare_exchange_strong(turn, (turn / 2 + 1) * 2);
}

// Timers: a binary heap whose items know their places.

void Reactor::schedule(Timer& timer, std::weak_ptr<void> owner, Time when) {
  const std::lock_guard lock(mutex_);
  take_out(timer);
  if (when == never || is_stopping_) return;
  timer.due_ = when;
  timer.owner_ = std::move(owner);
  timers_.push_back(&timer);
  timer.place_ = timers_.size() - 1;
  sift_up(timer.place_);
  if (timer.place_ == 0) watch_.notify_one();
}

void Reactor::cancel(Timer& timer) {
  const std::lock_guard lock(mutex_);
  take_out(timer);
}

// Returns when the next one is due.
Time Reactor::run_timers(std::unique_lock<std::mutex>& lock) {
  while (!timers_.empty()) {
    Timer* const timer = timers_.front();
    if (timer->due_ > Clock::now()) return timer->due_;
    std::shared_ptr<void> owner = timer->owner_.lock();
    take_out(*timer);
    lock.unlock();
    if (owner) timer->on_timer();
    owner.reset();
    lock.lock();
  }
  return never;
}

void Reactor::put(std::size_t place, Timer* timer) {
  timers_[place] = timer;
  timer->place_ = place;
}

void Reactor::sift_up(std::size_t place) {
  Timer* const timer = timers_[place];
  while (place != 0) {
    const std::size_t parent = (place - 1) / 2;
    if (timers_[parent]->due_ <= timer->due_) break;
    put(place, timers_[parent]);
    place = parent;
  }
  put(place, timer);
}

void Reactor::sift_down(std::size_t place) {
  Timer* const timer = timers_[place];
  while (true) {
    std::size_t child = 2 * place + 1;
    if (child >= timers_.size()) break;
    if (child + 1 < timers_.size() && timers_[child + 1]->due_ < timers_[child]->due_) ++child;
    if (timers_[child]->due_ >= timer->due_) break;
    put(place, timers_[child]);
    place = child;
  }
  put(place, timer);
}

void Reactor::take_out(Timer& timer) {
  const std::size_t place = std::exchange(timer.place_, Timer::unscheduled);
  if (place == Timer::unscheduled) return;
  timer.owner_.reset();
  Timer* const last = timers_.back();
  timers_.pop_back();
  if (last == &timer) return;
  put(place, last);
  sift_down(place);
  sift_up(last->place_);
}

}  // namespace rr::channel
