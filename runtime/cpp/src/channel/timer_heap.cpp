// SPDX-License-Identifier: Apache-2.0
#include "runtime/cpp/src/channel/timer_heap.hpp"

#include <utility>

namespace rr::channel {

[[gnu::hot]] bool TimerHeap::schedule(Timer& timer, std::weak_ptr<void> owner, Time when) {
  cancel(timer);
  if (when == never) return false;
  timer.due_ = when;
  timer.owner_ = std::move(owner);
  timers_.push_back(&timer);
  timer.place_ = timers_.size() - 1;
  sift_up(timer.place_);
  return timer.place_ == 0;
}

[[gnu::hot]] void TimerHeap::cancel(Timer& timer) {
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

TimerHeap::Due TimerHeap::take_first() {
  Timer& timer = *timers_.front();
  std::shared_ptr<void> owner = timer.owner_.lock();
  cancel(timer);
  return {timer, std::move(owner)};
}

void TimerHeap::put(std::size_t place, Timer* timer) {
  timers_[place] = timer;
  timer->place_ = place;
}

void TimerHeap::sift_up(std::size_t place) {
  Timer* const timer = timers_[place];
  while (place != 0) {
    const std::size_t parent = (place - 1) / 2;
    if (timers_[parent]->due_ <= timer->due_) break;
    put(place, timers_[parent]);
    place = parent;
  }
  put(place, timer);
}

void TimerHeap::sift_down(std::size_t place) {
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

}  // namespace rr::channel
