// SPDX-License-Identifier: Apache-2.0
#include "runtime/cpp/src/channel/late_work.hpp"

#include <deque>
#include <system_error>
#include <utility>

#include "rr/mutex.hpp"

namespace rr::channel {

struct LateWork::Queue {
  Mutex mutex;
  Condition ended;
  std::deque<std::function<void()>> work RR_GUARDED_BY(mutex);
  bool has_thread RR_GUARDED_BY(mutex) = false;
  std::thread::id runner RR_GUARDED_BY(mutex);  // the thread, once it runs
  std::thread thread RR_GUARDED_BY(mutex);      // the last one, which may have ended

  // Of a thread that has ended, but for its last instructions.
  void join() RR_REQUIRES(mutex) {
    if (thread.joinable()) thread.join();
  }

  void run() {
    MutexLock lock(mutex);
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
  const MutexLock lock(queue_->mutex);
  if (queue_->thread.joinable()) queue_->thread.detach();  // this is it
}

void LateWork::add(std::function<void()> work) {
  const MutexLock lock(queue_->mutex);
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
  MutexLock lock(queue_->mutex);
  if (queue_->runner == std::this_thread::get_id()) return;
  while (queue_->has_thread) queue_->ended.wait(queue_->mutex);
  if (!queue_->work.empty()) {
    queue_->has_thread = true;
    lock.unlock();
    queue_->run();
    lock.lock();
  }
  if (!queue_->has_thread) queue_->join();
}

bool LateWork::is_own_thread() const {
  const MutexLock lock(queue_->mutex);
  return queue_->runner == std::this_thread::get_id();
}

}  // namespace rr::channel
