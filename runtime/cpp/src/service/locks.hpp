// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <atomic>
#include <cstddef>
#include <cstdint>
#include <functional>
#include <map>
#include <string>
#include <string_view>
#include <vector>

#include "rr/mutex.hpp"
#include "rr/users.hpp"

namespace rr::service {

struct ServedObject;

/// Which objects of a service are locked for whom (07, section 6). What a client's own object is
/// locked for concerns no other client's at the same path.
class Locks {
 public:
  /// A session may have so many, and so may a user besides.
  explicit Locks(std::size_t limit) : limit_(limit) {}

  /// A session begins; before it, and after leave(), it can lock nothing.
  void enter(std::uint32_t endpoint);
  /// It has logged in; it counts as one of the user's until it ends.
  void log_in(std::uint32_t endpoint, const User& user);
  /// It ends, and with it its locks, and those of users who have no other.
  void leave(std::uint32_t endpoint);

  /// Throws rr::Error: object_locked_error when the object, or one above or below, is locked,
  /// out_of_system_resource when the session or the user has too many.
  void request(const ServedObject& object, const User& user, std::uint32_t endpoint,
               bool for_session);
  /// For the service, which may say whose the lock is; empty: nobody's. It ends with unlock(), or
  /// as release() says. Throws as request() does for what is locked already.
  void lock(const ServedObject& object, const std::string& user);
  /// Ends all locks at this very path, whoever has them; whether there was one.
  bool unlock(std::string_view path);
  /// Throws rr::Error (object_locked_error) unless the lock is at this object and the user's, or
  /// may be overridden.
  void release(const ServedObject& object, const User& user);
  /// Ends the locks of a user, and of this session, at paths for which `is_over` holds. Returns how
  /// many.
  std::size_t end_if(std::uint32_t endpoint, const User& user,
                     const std::function<bool(std::string_view)>& is_over);
  /// The object goes away.
  void forget(const ServedObject& object);

  /// Whether there is any.
  [[nodiscard]] bool are_held() const { return are_held_.load(std::memory_order_acquire); }
  /// Whether an object or one below it is locked.
  [[nodiscard]] bool are_on(const ServedObject& object) const;
  /// Throws rr::Error (object_locked_error) for an object that is locked for others. `user` is null
  /// for nobody.
  void check(const ServedObject& object, const User* user, std::uint32_t endpoint) const;

 private:
  struct Lock {
    std::string path;
    std::uint32_t owner;  // of the object
    std::string user;
    std::uint32_t endpoint;      // 0: of the user
    bool is_of_service = false;  // stays without a session

    [[nodiscard]] bool holds_for(const ServedObject& object) const;
    [[nodiscard]] bool is_above_or_below(const ServedObject& object) const;
    [[nodiscard]] bool is_at(const ServedObject& object) const;
    [[nodiscard]] std::string who(const std::string& prefix) const;
  };
  void need_unlocked(const ServedObject& object) const RR_REQUIRES(mutex_);
  template <class Condition>
  void remove_if(Condition condition) RR_REQUIRES(mutex_);

  const std::size_t limit_;
  mutable Mutex mutex_;
  std::atomic<bool> are_held_{false};
  std::vector<Lock> locks_ RR_GUARDED_BY(mutex_);
  std::map<std::uint32_t, std::vector<std::string>> sessions_
      RR_GUARDED_BY(mutex_);  // who has logged in there
};

}  // namespace rr::service
