// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <chrono>
#include <condition_variable>
#include <mutex>

#include "rr/visibility.hpp"

/// Locks of the runtime, with the annotations that `clang -Wthread-safety` checks. The standard
/// library's mutexes have none where it is libstdc++. Programs need nothing of this: it is here for
/// the classes in public headers that hold a mutex.

#if defined(__clang__)
/// An attribute of clang; nothing for other compilers.
#define RR_THREAD_ANNOTATION(x) __attribute__((x))
#else
#define RR_THREAD_ANNOTATION(x)
#endif

/// The class is a lock.
#define RR_CAPABILITY(name) RR_THREAD_ANNOTATION(capability(name))
/// The class holds a lock from its constructor to its destructor.
#define RR_SCOPED_CAPABILITY RR_THREAD_ANNOTATION(scoped_lockable)
/// The variable is used with this lock held.
#define RR_GUARDED_BY(lock) RR_THREAD_ANNOTATION(guarded_by(lock))
/// What the pointer leads to is used with this lock held.
#define RR_PT_GUARDED_BY(lock) RR_THREAD_ANNOTATION(pt_guarded_by(lock))
/// The lock is taken before these, where a thread has both.
#define RR_ACQUIRED_BEFORE(...) RR_THREAD_ANNOTATION(acquired_before(__VA_ARGS__))
/// Callers of the function hold these locks.
#define RR_REQUIRES(...) RR_THREAD_ANNOTATION(requires_capability(__VA_ARGS__))
/// Callers of the function do not hold these locks: it takes them, or waits for a thread that does.
#define RR_EXCLUDES(...) RR_THREAD_ANNOTATION(locks_excluded(__VA_ARGS__))
/// The function takes these locks.
#define RR_ACQUIRE(...) RR_THREAD_ANNOTATION(acquire_capability(__VA_ARGS__))
/// The function takes the lock where it returns its first argument.
#define RR_TRY_ACQUIRE(...) RR_THREAD_ANNOTATION(try_acquire_capability(__VA_ARGS__))
/// The function releases these locks.
#define RR_RELEASE(...) RR_THREAD_ANNOTATION(release_capability(__VA_ARGS__))
/// The function returns this lock.
#define RR_RETURN_CAPABILITY(lock) RR_THREAD_ANNOTATION(lock_returned(lock))
/// From the call of the function on its caller holds this lock, as far as the analysis is
/// concerned.
#define RR_ASSERT_CAPABILITY(lock) RR_THREAD_ANNOTATION(assert_capability(lock))
/// The function is not looked at. A comment says why.
#define RR_NO_THREAD_SAFETY_ANALYSIS RR_THREAD_ANNOTATION(no_thread_safety_analysis)

namespace RR_VISIBLE rr {

/// A std::mutex that the analysis knows.
class RR_CAPABILITY("mutex") Mutex {
 public:
  Mutex() = default;
  ~Mutex() = default;
  Mutex(const Mutex&) = delete;
  Mutex& operator=(const Mutex&) = delete;

  /// As std::mutex; MutexLock is for nearly all uses.
  void lock() RR_ACQUIRE() { mutex_.lock(); }
  /// As std::mutex.
  void unlock() RR_RELEASE() { mutex_.unlock(); }
  /// As std::mutex.
  bool try_lock() RR_TRY_ACQUIRE(true) { return mutex_.try_lock(); }
  /// Tells the analysis that the calling thread holds this one, where it knows it by another name.
  /// Nothing is checked.
  void assert_held() const RR_ASSERT_CAPABILITY(this) {}

 private:
  friend class Condition;
  std::mutex mutex_;
};

/// Holds a mutex for as long as it exists, and may release it in between.
class RR_SCOPED_CAPABILITY MutexLock {
 public:
  /// Waits for the mutex.
  explicit MutexLock(Mutex& mutex) RR_ACQUIRE(mutex) : mutex_(mutex) { mutex_.lock(); }
  ~MutexLock() RR_RELEASE() {
    if (is_held_) mutex_.unlock();
  }
  MutexLock(const MutexLock&) = delete;
  MutexLock& operator=(const MutexLock&) = delete;

  /// Takes the mutex again.
  void lock() RR_ACQUIRE() {
    mutex_.lock();
    is_held_ = true;
  }
  /// Releases the mutex now.
  void unlock() RR_RELEASE() {
    is_held_ = false;
    mutex_.unlock();
  }

 private:
  Mutex& mutex_;
  bool is_held_ = true;
};

/// Releases a mutex for as long as it exists: for functions whose callers hold it.
class RR_SCOPED_CAPABILITY MutexUnlock {
 public:
  /// The calling thread holds the mutex.
  explicit MutexUnlock(Mutex& mutex) RR_RELEASE(mutex) : mutex_(mutex) { mutex_.unlock(); }
  // Ends the release, which is how the analysis writes that the mutex is held again.
  ~MutexUnlock() RR_RELEASE() { mutex_.lock(); }
  MutexUnlock(const MutexUnlock&) = delete;
  MutexUnlock& operator=(const MutexUnlock&) = delete;

 private:
  Mutex& mutex_;
};

/// A std::condition_variable for a Mutex that the calling thread holds. It is held again after each
/// wait; returns without a notification are possible, so waits are in a loop.
class Condition {
 public:
  /// Waits for a notification.
  void wait(Mutex& mutex) RR_REQUIRES(mutex) {
    std::unique_lock lock(mutex.mutex_, std::adopt_lock);
    condition_.wait(lock);
    lock.release();
  }
  /// Waits for a notification or `deadline`.
  template <class Clock, class Duration>
  std::cv_status wait_until(Mutex& mutex, const std::chrono::time_point<Clock, Duration>& deadline)
      RR_REQUIRES(mutex) {
    std::unique_lock lock(mutex.mutex_, std::adopt_lock);
    const std::cv_status status = condition_.wait_until(lock, deadline);
    lock.release();
    return status;
  }
  /// Waits until `is_true()` or `deadline`; returns what `is_true()` says then. Not analyzed: the
  /// lock that `is_true` requires has another name here.
  template <class Clock, class Duration, class Predicate>
  bool wait_until(Mutex& mutex, const std::chrono::time_point<Clock, Duration>& deadline,
                  Predicate is_true) RR_REQUIRES(mutex) RR_NO_THREAD_SAFETY_ANALYSIS {
    while (!is_true()) {
      if (wait_until(mutex, deadline) == std::cv_status::timeout) return is_true();
    }
    return true;
  }
  /// Wakes one thread that waits.
  void notify_one() noexcept { condition_.notify_one(); }
  /// Wakes all threads that wait.
  void notify_all() noexcept { condition_.notify_all(); }

 private:
  std::condition_variable condition_;
};

}  // namespace rr
