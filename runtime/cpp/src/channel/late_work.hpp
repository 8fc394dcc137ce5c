// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <functional>
#include <memory>
#include <thread>

namespace rr::channel {

/// Runs work on a thread of its own, which exists only while there is any: for what comes when the
/// threads of a node have ended.
class LateWork {
 public:
  LateWork();
  /// Waits as wait() does.
  ~LateWork();
  LateWork(const LateWork&) = delete;
  LateWork& operator=(const LateWork&) = delete;

  /// Runs `work` soon, behind what was added before; when there can be no thread, in the next
  /// wait().
  void add(std::function<void()> work);
  /// Waits until there is none left; not when called by it.
  void wait();
  [[nodiscard]] bool is_own_thread() const;

 private:
  struct Queue;
  const std::shared_ptr<Queue> queue_;  // the thread's too: the last work may own this object
};

}  // namespace rr::channel
