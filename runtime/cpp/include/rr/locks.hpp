// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <chrono>
#include <cstdint>
#include <utility>

#include "rr/call.hpp"
#include "rr/stub.hpp"
#include "rr/visibility.hpp"

/// Keeping others from an object of a service (07, section 6). All throw rr::Error.
namespace RR_VISIBLE rr {

/// For whom an object is locked: `user`, all sessions of the user, or `session`, this session
/// alone.
enum class LockOwner : std::uint8_t { user, session };

/// Locks an object and all below it for others, whose requests fail with object_locked_error.
/// Needs a service with users, one that is logged in (authentication_error), and has the privilege
/// `objectlock` (object_locked_error). An object that is locked, or has one below that is, cannot
/// be locked again: object_locked_error. The lock ends with the session, or, for a user, with the
/// last one of that user.
void lock(const Stub& object, LockOwner owner = LockOwner::user, const CallOptions& options = {});
/// Ends a lock at the object at which it was made. Nothing happens when there is none. The lock of
/// another user needs the privilege `objectlockoverride`.
void unlock(const Stub& object, const CallOptions& options = {});

/// As a time for enter_monitor(): as long as it takes.
inline constexpr std::chrono::milliseconds wait_forever = std::chrono::milliseconds::max();

/// Waits until this session alone may use the object, which others are refused with
/// invalid_operation meanwhile. invalid_argument when the object has no monitor, operation_timeout
/// when it is not free in time. A session that does not use the object for 30 s loses it.
void enter_monitor(const Stub& object, std::chrono::milliseconds timeout = wait_forever);
/// Leaves the monitor that this session has entered. Services may say nothing when it has entered
/// none.
void exit_monitor(const Stub& object);

/// Is in the monitor of an object while it exists:
///
///   const rr::MonitorLock in(*arm, 2s);
///   arm->move_to(1, 0);
///
/// The stub must live as long.
class [[nodiscard]] MonitorLock {
 public:
  /// Enters the monitor, as enter_monitor().
  explicit MonitorLock(const Stub& object, std::chrono::milliseconds timeout = wait_forever)
      : object_(&object) {
    enter_monitor(object, timeout);
  }
  /// `other` is in the monitor no more.
  MonitorLock(MonitorLock&& other) noexcept : object_(std::exchange(other.object_, nullptr)) {}
  MonitorLock& operator=(MonitorLock&&) = delete;
  /// A failure is not told: the monitor is then lost with the session.
  ~MonitorLock();
  /// Leaves it now.
  void exit() {
    if (const Stub* const object = std::exchange(object_, nullptr)) exit_monitor(*object);
  }

 private:
  const Stub* object_;
};

}  // namespace rr
