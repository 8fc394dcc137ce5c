// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <chrono>
#include <cstddef>
#include <deque>
#include <functional>
#include <optional>
#include <string>
#include <utility>

#include "rr/mutex.hpp"

namespace robdef::live {

/// From the threads of the node to the one that prints. Whoever puts a line where no more fit
/// waits: so a wire skips values, and the rest is held back at its sender.
class WatchQueue {
 public:
  struct Item {
    std::string line;
    std::function<void()> work;  ///< instead of a line
  };

  void put_line(std::string line) {
    const rr::MutexLock lock(mutex_);
    while (!is_closed_ && items_.size() >= limit) changed_.wait(mutex_);
    if (is_closed_) return;
    items_.push_back({std::move(line), {}});
    changed_.notify_all();
  }
  /// Does not wait.
  void put_work(std::function<void()> work) {
    const rr::MutexLock lock(mutex_);
    if (is_closed_) return;
    items_.push_back({{}, std::move(work)});
    changed_.notify_all();
  }
  /// Nothing when none has come in time.
  std::optional<Item> take(std::chrono::steady_clock::time_point until) {
    const rr::MutexLock lock(mutex_);
    const auto has_items = [&]() RR_REQUIRES(mutex_) { return !items_.empty(); };
    if (!changed_.wait_until(mutex_, until, has_items)) return std::nullopt;
    Item item = std::move(items_.front());
    items_.pop_front();
    changed_.notify_all();
    return item;
  }
  /// Nobody waits any more.
  void close() {
    std::deque<Item> left;
    const rr::MutexLock lock(mutex_);
    is_closed_ = true;
    left.swap(items_);
    changed_.notify_all();
  }

 private:
  static constexpr std::size_t limit = 1024;
  rr::Mutex mutex_;
  rr::Condition changed_;
  std::deque<Item> items_ RR_GUARDED_BY(mutex_);
  bool is_closed_ RR_GUARDED_BY(mutex_) = false;
};

}  // namespace robdef::live
