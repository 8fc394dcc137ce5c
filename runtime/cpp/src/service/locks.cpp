// SPDX-License-Identifier: Apache-2.0
#include "runtime/cpp/src/service/locks.hpp"

#include <algorithm>
#include <utility>

#include "rr/error.hpp"
#include "rr/mutex.hpp"
#include "runtime/cpp/src/endpoint/service_path.hpp"
#include "runtime/cpp/src/service/object_tree.hpp"

namespace rr::service {

using endpoint::is_at_or_below;

// An object of all has clients' own ones below it, never above.
bool Locks::Lock::holds_for(const ServedObject& object) const {
  return (owner == 0 || owner == object.owner) && is_at_or_below(object.path, path);
}
bool Locks::Lock::is_above_or_below(const ServedObject& object) const {
  return holds_for(object) ||
         ((object.owner == 0 || owner == object.owner) && is_at_or_below(path, object.path));
}

bool Locks::Lock::is_at(const ServedObject& object) const {
  return path == object.path && owner == object.owner;
}

std::string Locks::Lock::who(const std::string& prefix) const {
  return user.empty() ? "the service" : prefix + user;
}

template <class Condition>
void Locks::remove_if(Condition condition) {
  std::erase_if(locks_, condition);
  are_held_.store(!locks_.empty(), std::memory_order_release);
}

void Locks::enter(std::uint32_t endpoint) {
  const MutexLock lock(mutex_);
  sessions_.try_emplace(endpoint);
}

void Locks::log_in(std::uint32_t endpoint, const User& user) {
  const MutexLock lock(mutex_);
  const auto session = sessions_.find(endpoint);
  if (session == sessions_.end()) return;
  std::vector<std::string>& users = session->second;
  if (std::find(users.begin(), users.end(), user.name) == users.end()) users.push_back(user.name);
}

void Locks::leave(std::uint32_t endpoint) {
  const MutexLock lock(mutex_);
  sessions_.erase(endpoint);
  remove_if([&](const Lock& held) RR_REQUIRES(mutex_) {
    if (held.is_of_service) return false;
    if (held.endpoint != 0) return held.endpoint == endpoint;
    return std::none_of(sessions_.begin(), sessions_.end(), [&](const auto& session) {
      return std::find(session.second.begin(), session.second.end(), held.user) !=
             session.second.end();
    });
  });
}

void Locks::need_unlocked(const ServedObject& object) const {
  for (const Lock& held : locks_) {
    if (held.is_above_or_below(object)) {
      throw Error(ErrorCode::object_locked_error, "Object already locked");
    }
  }
}

void Locks::lock(const ServedObject& object, const std::string& user) {
  const MutexLock lock(mutex_);
  need_unlocked(object);
  locks_.push_back({object.path, object.owner, user, 0, true});
  are_held_.store(true, std::memory_order_release);
}

bool Locks::unlock(std::string_view path) {
  const MutexLock lock(mutex_);
  const std::size_t before = locks_.size();
  remove_if([&](const Lock& held) { return held.path == path; });
  return locks_.size() != before;
}

void Locks::request(const ServedObject& object, const User& user, std::uint32_t endpoint,
                    bool for_session) {
  const MutexLock lock(mutex_);
  need_unlocked(object);
  if (!sessions_.contains(endpoint)) {
    throw Error(ErrorCode::connection_error, "the session has ended");
  }
  const auto count = std::count_if(locks_.begin(), locks_.end(), [&](const Lock& held) {
    if (held.is_of_service) return false;
    return for_session ? held.endpoint == endpoint : held.endpoint == 0 && held.user == user.name;
  });
  if (static_cast<std::size_t>(count) >= limit_) {
    throw Error(ErrorCode::out_of_system_resource,
                "more than " + std::to_string(limit_) + " locks of one session or user");
  }
  locks_.push_back({object.path, object.owner, user.name, for_session ? endpoint : 0});
  are_held_.store(true, std::memory_order_release);
}

void Locks::release(const ServedObject& object, const User& user) {
  const MutexLock lock(mutex_);
  for (const Lock& held : locks_) {
    if (!held.holds_for(object)) continue;
    if (held.user != user.name && !user.has(override_lock_privilege)) {
      throw Error(ErrorCode::object_locked_error, "Service locked by " + held.who("user "));
    }
    if (held.path != object.path) {
      throw Error(ErrorCode::object_locked_error, "The lock is at the object " + held.path);
    }
    remove_if([&](const Lock& other) { return &other == &held; });
    return;
  }
}

std::size_t Locks::end_if(std::uint32_t endpoint, const User& user,
                          const std::function<bool(std::string_view)>& is_over) {
  const MutexLock lock(mutex_);
  const std::size_t before = locks_.size();
  remove_if([&](const Lock& held) {
    return !held.is_of_service && held.user == user.name &&
           (held.endpoint == 0 || held.endpoint == endpoint) && is_over(held.path);
  });
  return before - locks_.size();
}

void Locks::forget(const ServedObject& object) {
  const MutexLock lock(mutex_);
  remove_if([&](const Lock& held) { return held.is_at(object); });
}

bool Locks::are_on(const ServedObject& object) const {
  if (!are_held()) return false;
  const MutexLock lock(mutex_);
  return std::any_of(locks_.begin(), locks_.end(), [&](const Lock& held) {
    return held.owner == object.owner && is_at_or_below(held.path, object.path);
  });
}

void Locks::check(const ServedObject& object, const User* user, std::uint32_t endpoint) const {
  const MutexLock lock(mutex_);
  for (const Lock& held : locks_) {
    if (!held.holds_for(object)) continue;
    const bool may_pass = user != nullptr && !held.user.empty() && user->name == held.user &&
                          (held.endpoint == 0 || held.endpoint == endpoint);
    if (!may_pass) throw Error(ErrorCode::object_locked_error, "Object locked by " + held.who(""));
  }
}

}  // namespace rr::service
