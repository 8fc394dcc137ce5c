// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <mutex>

#include "rr/mutex.hpp"

namespace rr {

/// A std::recursive_mutex that the thread safety analysis knows. It sees each function by itself,
/// so a thread may take the mutex again in another function.
class RR_CAPABILITY("mutex") RecursiveMutex {
 public:
  RecursiveMutex() = default;
  ~RecursiveMutex() = default;
  RecursiveMutex(const RecursiveMutex&) = delete;
  RecursiveMutex& operator=(const RecursiveMutex&) = delete;

  void lock() RR_ACQUIRE() { mutex_.lock(); }
  void unlock() RR_RELEASE() { mutex_.unlock(); }

 private:
  std::recursive_mutex mutex_;
};

/// Holds a recursive mutex for as long as it exists.
class RR_SCOPED_CAPABILITY RecursiveMutexLock {
 public:
  explicit RecursiveMutexLock(RecursiveMutex& mutex) RR_ACQUIRE(mutex) : mutex_(mutex) {
    mutex_.lock();
  }
  ~RecursiveMutexLock() RR_RELEASE() { mutex_.unlock(); }
  RecursiveMutexLock(const RecursiveMutexLock&) = delete;
  RecursiveMutexLock& operator=(const RecursiveMutexLock&) = delete;

 private:
  RecursiveMutex& mutex_;
};

}  // namespace rr
