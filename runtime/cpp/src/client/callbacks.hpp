// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <memory>
#include <string>
#include <string_view>
#include <thread>
#include <vector>

#include "rr/callbacks.hpp"
#include "rr/definition.hpp"
#include "rr/mutex.hpp"
#include "rr/stub.hpp"

namespace rr::client {

/// A callback of a stub that has, or had, a function.
class CallbackSlot {
 public:
  CallbackSlot(const Stub& of, const Member& callback)
      : stub(&of), path(of.rr_path()), member(&callback) {}

  const Stub* const stub;  // compared only
  const std::string path;
  const Member* const member;

  void set(std::unique_ptr<CallbackFunction> function);
  /// Returns when the function runs nowhere any more, unless it is the caller.
  void clear();
  /// Calls the function; several threads may at once. Throws rr::Error (invalid_operation) when
  /// there is none, and what it throws.
  std::shared_ptr<const void> call(const Arguments& arguments);

 private:
  Mutex mutex_;
  Condition ended_;
  std::shared_ptr<CallbackFunction> function_ RR_GUARDED_BY(mutex_);
  std::vector<std::thread::id> running_ RR_GUARDED_BY(mutex_);
};

/// The functions that a client has given to the callbacks of its stubs. No user code runs, and
/// nothing of the user's is destroyed, under a lock.
class Callbacks {
 public:
  void set(const Stub& stub, const Member& member, std::unique_ptr<CallbackFunction> function);
  void clear(const Stub& stub, const Member& member);
  /// Clears those of a stub that goes away.
  void forget(const Stub& stub);
  /// The session has ended: no function is called any more, nor kept.
  void end();
  /// Null when the callback never had a function.
  std::shared_ptr<CallbackSlot> find(std::string_view path, std::string_view member);

 private:
  std::shared_ptr<CallbackSlot> find_locked(const Stub& stub, const Member& member)
      RR_REQUIRES(mutex_);

  Mutex mutex_;
  bool has_ended_ RR_GUARDED_BY(mutex_) = false;
  std::vector<std::shared_ptr<CallbackSlot>> slots_ RR_GUARDED_BY(mutex_);
};

}  // namespace rr::client
