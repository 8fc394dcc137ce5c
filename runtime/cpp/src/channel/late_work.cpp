// SPDX-License-Identifier: Apache-2.0
#include "runtime/cpp/src/channel/late_work.hpp"

#include <condition_variable>
#include <deque>
#include <mutex>
#include <system_error>
#include <utility>

namespace rr::channel {

struct LateWork::Queue {
  std::mutex mutex;
  std::condition_variable ended;
  std::deque<std::function<void()>> work;
  bool has_thread = false;
  std::thread::id runner;  // the thread, once it runs
  std::thread thread;      // the last one, which may have ended

  // Under the lock. Of a thread that has ended, but for its last instructions.
  void join() {
    if (thread.joinable()) thread.join();
  }

  void run() {
    std::unique_lock lock(mutex);
    runner = std::this_thread::get_id();
    while (!work.empty()) {
      std::function<void()> next = std::move(work.front());
      work.pop_front();
      lock.unlock();
      try {
        next();
      } catch (...) {
        // Nobody is left who could be told.
      }
      next = nullptr;
      lock.lock();
    }
    has_thread = false;
    runner = {};
    ended.notify_all();
  }
};

LateWork::LateWork() : queue_(std::make_shared<Queue>()) {}

LateWork::~LateWork() {
  wait();
  const std::lock_guard lock(queue_->mutex);
  if (queue_->thread.joinable()) queue_->thread.detach();  // this is it
}

void LateWork::add(std::function<void()> work) {
  const std::lock_guard lock(queue_->mutex);
  queue_->work.push_back(std::move(work));
  if (std::exchange(queue_->has_thread, true)) return;
  queue_->join();
  try {
    queue_->thread = std::thread([queue = queue_] { queue->run(); });
  } catch (const std::system_error&) {
    queue_->has_thread = false;  // then whoever waits does it
  }
}

void LateWork::wait() {
  std::unique_lock lock(queue_->mutex);
  if (queue_->runner == std::this_thread::get_id()) return;
  queue_->ended.wait(lock, [&] { return !queue_->has_thread; });
  if (!queue_->work.empty()) {
    queue_->has_thread = true;
    lock.unlock();
    queue_->run();
    lock.lock();
  }
  if (!queue_->has_thread) queue_->join();
}

bool LateWork::is_own_thread() const {
  const std::lock_guard lock(queue_->mutex);
  return queue_->runner == std::this_thread::get_id();
}

}  // namespace rr::channel
