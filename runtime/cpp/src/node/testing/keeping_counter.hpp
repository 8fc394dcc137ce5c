// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <cstddef>
#include <cstdint>
#include <memory>
#include <mutex>
#include <utility>
#include <vector>

#include "runtime/cpp/src/node/testing/pair.hpp"

namespace rr::testing {

/// Whose `slow` is answered when somebody says so.
class KeepingCounter : public Counter {
 public:
  void slow(Reply<void> reply, std::int32_t /*milliseconds*/) override {
    const std::lock_guard lock(mutex_);
    replies_.push_back(std::move(reply));
  }
  void answer_all() {
    const std::lock_guard lock(mutex_);
    for (Reply<void>& reply : replies_) reply();
    replies_.clear();
  }
  [[nodiscard]] std::size_t kept() {
    const std::lock_guard lock(mutex_);
    return replies_.size();
  }

 private:
  std::mutex mutex_;
  std::vector<Reply<void>> replies_;
};

struct KeepingPair {
  std::shared_ptr<KeepingCounter> object = std::make_shared<KeepingCounter>();
  Pair pair{{}, {}, object};
  Client<CounterStub> counter = pair.connect();
};

}  // namespace rr::testing
