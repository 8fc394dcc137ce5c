// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <cstddef>
#include <memory>
#include <utility>

#include "rr/mutex.hpp"

namespace rr::channel {

/// How many memories of wires there may be, and how many bytes they may have together. Any thread.
class SlotBudget {
 public:
  struct Limits {
    std::size_t bytes = 0;
    std::size_t count = 0;
  };
  explicit SlotBudget(const Limits& limits) : limits_(limits) {}
  SlotBudget(const SlotBudget&) = delete;
  SlotBudget& operator=(const SlotBudget&) = delete;

  /// False, and nothing happens, when one more of so many bytes is too much.
  [[nodiscard]] bool draw(std::size_t bytes) {
    const MutexLock lock(mutex_);
    if (count_ >= limits_.count || bytes > limits_.bytes - bytes_) return false;
    bytes_ += bytes;
    ++count_;
    return true;
  }
  /// One that was drawn.
  void give_back(std::size_t bytes) {
    const MutexLock lock(mutex_);
    bytes_ -= bytes;
    --count_;
  }
  [[nodiscard]] std::size_t bytes() const {
    const MutexLock lock(mutex_);
    return bytes_;
  }
  [[nodiscard]] std::size_t count() const {
    const MutexLock lock(mutex_);
    return count_;
  }

 private:
  const Limits limits_;
  mutable Mutex mutex_;
  std::size_t bytes_ RR_GUARDED_BY(mutex_) = 0;
  std::size_t count_ RR_GUARDED_BY(mutex_) = 0;
};

/// One memory of a budget, for as long as this exists.
class SlotShare {
 public:
  SlotShare() = default;
  /// Nothing was drawn when is_drawn() is false.
  SlotShare(std::shared_ptr<SlotBudget> budget, std::size_t bytes) : bytes_(bytes) {
    if (budget->draw(bytes)) budget_ = std::move(budget);
  }
  SlotShare(SlotShare&& other) noexcept
      : budget_(std::move(other.budget_)), bytes_(std::exchange(other.bytes_, 0)) {}
  SlotShare& operator=(SlotShare&& other) noexcept {
    std::swap(budget_, other.budget_);
    std::swap(bytes_, other.bytes_);
    return *this;
  }
  ~SlotShare() {
    if (budget_) budget_->give_back(bytes_);
  }

  [[nodiscard]] bool is_drawn() const { return budget_ != nullptr; }

 private:
  std::shared_ptr<SlotBudget> budget_;
  std::size_t bytes_ = 0;
};

}  // namespace rr::channel
