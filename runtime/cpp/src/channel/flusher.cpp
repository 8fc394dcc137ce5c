// SPDX-License-Identifier: Apache-2.0
#include "runtime/cpp/src/channel/flusher.hpp"

#include <system_error>
#include <utility>

#include "runtime/cpp/src/platform/threads.hpp"

namespace rr::channel {

Flusher::~Flusher() { stop(); }

bool Flusher::add(std::shared_ptr<Flushable> flushable) {
  {
    const MutexLock lock(mutex_);
    if (is_stopping_) return true;
    try {
      if (!thread_.joinable()) thread_ = std::thread([this] { run(); });
    } catch (const std::system_error&) {
      return false;  // tried again with the next one
    }
    due_.push_back(std::move(flushable));
  }
  wake_.notify_one();
  return true;
}

void Flusher::stop() {
  std::thread thread;
  {
    const MutexLock lock(mutex_);
    is_stopping_ = true;
    thread = std::move(thread_);
  }
  wake_.notify_one();
  if (thread.joinable()) thread.join();
}

void Flusher::run() {
  // Woken on the producer's own processor it would send one message at a time; it may wait there
  // until the producer pauses, or has gathered enough to send itself.
  platform::prefer_throughput();
  std::vector<std::shared_ptr<Flushable>> due;
  MutexLock lock(mutex_);
  while (true) {
    if (due_.empty()) {
      if (is_stopping_) return;
      wake_.wait(mutex_);
      continue;
    }
    due.swap(due_);
    lock.unlock();
    for (const std::shared_ptr<Flushable>& flushable : due) flushable->flush_streamed();
    due.clear();
    lock.lock();
  }
}

}  // namespace rr::channel
