// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <memory>
#include <thread>
#include <vector>

#include "rr/mutex.hpp"

namespace rr::channel {

/// Something that keeps messages back for a moment.
class Flushable {
 public:
  /// Sends them; does not block. Once for each time it was handed to the flusher.
  virtual void flush_streamed() = 0;

 protected:
  ~Flushable() = default;
};

/// Sends what producers that never pause have left behind, on a thread of its own: while it is in a
/// system call, more gathers, which leaves with the next. No time is waited for, and who sends is
/// not held up. The thread is made when it is first needed, sleeps between, and never pushes a
/// producer from its processor.
class Flusher {
 public:
  Flusher() = default;
  ~Flusher();
  Flusher(const Flusher&) = delete;
  Flusher& operator=(const Flusher&) = delete;

  /// Nothing happens when it has been stopped. False when there is no thread for it: somebody else
  /// has to flush.
  [[nodiscard]] bool add(std::shared_ptr<Flushable> flushable);
  /// What was added before is flushed.
  void stop();

 private:
  void run();

  Mutex mutex_;
  Condition wake_;
  std::vector<std::shared_ptr<Flushable>> due_ RR_GUARDED_BY(mutex_);
  bool is_stopping_ RR_GUARDED_BY(mutex_) = false;
  std::thread thread_ RR_GUARDED_BY(mutex_);
};

}  // namespace rr::channel
