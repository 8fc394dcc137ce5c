// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <atomic>
#include <cstdint>
#include <map>
#include <mutex>
#include <string>
#include <string_view>
#include <vector>

#include "rr/users.hpp"

namespace rr::service {

/// Which objects of a service are locked for whom (07, section 6). Paths are canonical.
class Locks {
 public:
  /// A session begins; before it, and after leave(), it can lock nothing.
  void enter(std::uint32_t endpoint);
  /// It has logged in; it counts as one of the user's until it ends.
  void log_in(std::uint32_t endpoint, const User& user);
  /// It ends, and with it its locks, and those of users who have no other.
  void leave(std::uint32_t endpoint);

  /// Throws rr::Error (object_locked_error) when the object, or one above or below, is locked.
  void request(std::string_view path, const User& user, std::uint32_t endpoint, bool for_session);
  /// Throws rr::Error (object_locked_error) unless the lock is at this object and the user's, or
  /// may be overridden.
  void release(std::string_view path, const User& user);
  /// The object goes away.
  void forget(std::string_view path);

  /// Whether there is any.
  [[nodiscard]] bool are_held() const { return are_held_.load(std::memory_order_acquire); }
  /// Throws rr::Error (object_locked_error) for an object that is locked for others. `user` is null
  /// for nobody.
  void check(std::string_view path, const User* user, std::uint32_t endpoint) const;

 private:
  struct Lock {
    std::string path;
    std::string user;
    std::uint32_t endpoint;  // 0: of the user
  };
  template <class Condition>
  void remove_if(Condition condition);

  mutable std::mutex mutex_;
  std::atomic<bool> are_held_{false};
  std::vector<Lock> locks_;
  std::map<std::uint32_t, std::vector<std::string>> sessions_;  // who has logged in there
};

}  // namespace rr::service
