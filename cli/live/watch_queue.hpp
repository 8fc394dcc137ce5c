// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <chrono>
#include <condition_variable>
#include <cstddef>
#include <deque>
#include <functional>
#include <mutex>
#include <optional>
#include <string>
#include <utility>

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
    std::unique_lock lock(mutex_);
    changed_.wait(lock, [&] { return is_closed_ || items_.size() < limit; });
    if (is_closed_) return;
    items_.push_back({std::move(line), {}});
    changed_.notify_all();
  }
  /// Does not wait.
  void put_work(std::function<void()> work) {
    const std::lock_guard lock(mutex_);
    if (is_closed_) return;
    items_.push_back({{}, std::move(work)});
    changed_.notify_all();
  }
  /// Nothing when none has come in time.
  std::optional<Item> take(std::chrono::steady_clock::time_point until) {
    std::unique_lock lock(mutex_);
    if (!changed_.wait_until(lock, until, [&] { return !items_.empty(); })) return std::nullopt;
    Item item = std::move(items_.front());
    items_.pop_front();
    changed_.notify_all();
    return item;
  }
  /// Nobody waits any more.
  void close() {
    std::deque<Item> left;
    const std::lock_guard lock(mutex_);
    is_closed_ = true;
    left.swap(items_);
    changed_.notify_all();
  }

 private:
  static constexpr std::size_t limit = 1024;
  std::mutex mutex_;
  std::condition_variable changed_;
  std::deque<Item> items_;
  bool is_closed_ = false;
};

}  // namespace robdef::live
