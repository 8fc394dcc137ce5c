// SPDX-License-Identifier: Apache-2.0
#include "gateway/worker.hpp"

#include <utility>

namespace rr::gateway {
namespace {

constexpr std::size_t most_tasks = 20'000;

}  // namespace

void Worker::start() {
  thread_ = std::thread([this] { run(); });
}

void Worker::post(Task task) {
  const MutexLock lock(mutex_);
  if (ends_) return;
  tasks_.push_back(std::move(task));
  changed_.notify_one();
}

void Worker::post_in_turn(Task task, std::size_t limit) {
  const MutexLock lock(mutex_);
  while (!ends_ && is_bounded_ && tasks_.size() >= limit) taken_.wait(mutex_);
  if (ends_) return;
  tasks_.push_back(std::move(task));
  changed_.notify_one();
}

void Worker::set_bounded(bool is_bounded) {
  {
    const MutexLock lock(mutex_);
    is_bounded_ = is_bounded;
  }
  taken_.notify_all();
}

bool Worker::has_room() const {
  const MutexLock lock(mutex_);
  return tasks_.size() < most_tasks;
}

void Worker::stop() {
  {
    const MutexLock lock(mutex_);
    ends_ = true;
  }
  changed_.notify_all();
  taken_.notify_all();
  if (thread_.joinable()) thread_.join();
}

void Worker::run() {
  auto next_tick = std::chrono::steady_clock::now() + period_;
  MutexLock lock(mutex_);
  for (;;) {
    changed_.wait_until(mutex_, next_tick,
                        [this]() RR_REQUIRES(mutex_) { return ends_ || !tasks_.empty(); });
    if (ends_) break;
    Task task;
    bool is_tick = false;
    if (std::chrono::steady_clock::now() >= next_tick) {
      is_tick = true;
      task = tick_;
    } else if (!tasks_.empty()) {
      task = std::move(tasks_.front());
      tasks_.pop_front();
      taken_.notify_one();
    }
    lock.unlock();
    if (task) task();
    task = nullptr;
    // Counted from its end, so that a slow one leaves time for the others.
    if (is_tick) next_tick = std::chrono::steady_clock::now() + period_;
    lock.lock();
  }
  // Tasks may own what ends here; not under the lock.
  const auto dropped = std::move(tasks_);
  lock.unlock();
}

}  // namespace rr::gateway
