// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <atomic>
#include <cstdint>
#include <map>
#include <mutex>
#include <string>
#include <vector>

#include "rr/users.hpp"

namespace rr::service {

struct ServedObject;

/// Which objects of a service are locked for whom (07, section 6). What a client's own object is
/// locked for concerns no other client's at the same path.
class Locks {
 public:
  /// A session begins; before it, and after leave(), it can lock nothing.
  void enter(std::uint32_t endpoint);
  /// It has logged in; it counts as one of the user's until it ends.
  void log_in(std::uint32_t endpoint, const User& user);
  /// It ends, and with it its locks, and those of users who have no other.
  void leave(std::uint32_t endpoint);

  /// Throws rr::Error (object_locked_error) when the object, or one above or below, is locked.
  void request(const ServedObject& object, const User& user, std::uint32_t endpoint,
               bool for_session);
  /// Throws rr::Error (object_locked_error) unless the lock is at this object and the user's, or
  /// may be overridden.
  void release(const ServedObject& object, const User& user);
  /// The object goes away.
  void forget(const ServedObject& object);

  /// Whether there is any.
  [[nodiscard]] bool are_held() const { return are_held_.load(std::memory_order_acquire); }
  /// Throws rr::Error (object_locked_error) for an object that is locked for others. `user` is null
  /// for nobody.
  void check(const ServedObject& object, const User* user, std::uint32_t endpoint) const;

 private:
  struct Lock {
    std::string path;
    std::uint32_t owner;  // of the object
    std::string user;
    std::uint32_t endpoint;  // 0: of the user

    [[nodiscard]] bool holds_for(const ServedObject& object) const;
    [[nodiscard]] bool is_above_or_below(const ServedObject& object) const;
  };
  template <class Condition>
  void remove_if(Condition condition);

  mutable std::mutex mutex_;
  std::atomic<bool> are_held_{false};
  std::vector<Lock> locks_;
  std::map<std::uint32_t, std::vector<std::string>> sessions_;  // who has logged in there
};

}  // namespace rr::service
