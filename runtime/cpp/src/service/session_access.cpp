// SPDX-License-Identifier: Apache-2.0
#include "runtime/cpp/src/service/session_access.hpp"

#include <string>
#include <utility>

#include "runtime/cpp/src/service/service_host.hpp"

namespace rr::service {
namespace {

Error not_authenticated() { return {ErrorCode::authentication_error, "User is not authenticated"}; }

// The first of the rights that would do.
std::string_view word_for(RightSet rights) {
  for (RightSet bit = 1; bit < all_rights; bit = static_cast<RightSet>(bit << 1U)) {
    if ((rights & bit) != 0) return right_name(static_cast<Right>(bit));
  }
  return right_name(Right::describe);
}

bool are_same(const User* a, const User* b) {
  if (a == nullptr || b == nullptr) return a == b;
  return a->name == b->name && a->privileges == b->privileges;
}

}  // namespace

void SessionAccess::open(const ServiceHost& host) {
  const MutexLock lock(mutex_);
  is_open_ = true;
  has_users_ = host.users() != nullptr;
  requires_user_ = host.requires_user();
  rights_ = host.rights();
  renew();
}

void SessionAccess::close() {
  const MutexLock lock(mutex_);
  is_open_ = false;
  user_.reset();
  rights_.reset();
  login_.fetch_add(1, std::memory_order_release);
  renew();
}

std::shared_ptr<const User> SessionAccess::user() const {
  const MutexLock lock(mutex_);
  return user_;
}

// What nobody had opened is the first user's, as far as that one may have it.
std::shared_ptr<const User> SessionAccess::log_in(std::shared_ptr<const User> user) {
  const MutexLock lock(mutex_);
  std::shared_ptr<const User> before = std::exchange(user_, std::move(user));
  if (before && are_same(before.get(), user_.get())) before.reset();
  if (before) login_.fetch_add(1, std::memory_order_release);
  renew();
  return before;
}

std::shared_ptr<const User> SessionAccess::log_out() {
  const MutexLock lock(mutex_);
  std::shared_ptr<const User> before = std::exchange(user_, nullptr);
  if (!before) return nullptr;
  login_.fetch_add(1, std::memory_order_release);
  renew();
  return before;
}

// They are asked for under the lock, so that of two changes the later one remains.
bool SessionAccess::renew_rights(const ServiceHost& host) {
  const MutexLock lock(mutex_);
  auto rights = host.rights();
  if (!is_open_ || rights_ == rights) return false;
  rights_ = std::move(rights);
  renew();
  return true;
}

void SessionAccess::renew() {
  grants_ = rights_ ? std::make_shared<const Grants>(rights_, user_.get()) : nullptr;
  std::uint32_t bits = 0;
  if (is_open_) bits |= connected;
  if (user_ || !requires_user_) bits |= admitted;
  if (user_ || !has_users_) bits |= known;
  if (rights_) bits |= ruled;
  const std::uint32_t next = standing_.load(std::memory_order_relaxed) / count + 1;
  standing_.store(next * count | bits, std::memory_order_release);
}

std::shared_ptr<const Grants> SessionAccess::grants() const {
  const MutexLock lock(mutex_);
  return grants_;
}

bool SessionAccess::is_open_to_all() const {
  const MutexLock lock(mutex_);
  return is_open_ && !has_users_ && !rights_;
}

bool SessionAccess::suffices(const AccessRow& row, std::uint32_t standing) {
  switch (row.needs) {
    case Needs::nothing:
      return true;
    case Needs::session:
      return (standing & connected) != 0;
    case Needs::user:
      return (standing & (connected | admitted)) == (connected | admitted);
    case Needs::user_always:
      return (standing & (connected | known)) == (connected | known);
  }
  return false;
}

RightSet SessionAccess::rights_of(std::string_view path, std::string_view member) const {
  const auto granted = grants();
  return granted ? granted->of(path, member) : all_rights;
}

[[gnu::hot]] bool SessionAccess::allows(const AccessRow& row, std::string_view path,
                                        std::string_view member) const {
  const std::uint32_t now = standing();
  if (!suffices(row, now)) return false;
  if (row.rights == 0 || (now & ruled) == 0) return true;
  return (rights_of(path, member) & row.rights) != 0;
}

void SessionAccess::check(const AccessRow& row, std::string_view path,
                          std::string_view member) const {
  if (!allows(row, path, member)) throw refusal(row, path, member);
}

Error SessionAccess::refusal(const AccessRow& row, std::string_view path,
                             std::string_view member) const {
  if (!suffices(row, standing())) return not_authenticated();
  const auto who = user();
  std::string text = who ? "User `" + who->name + "`" : "A client that is not logged in";
  text += " may not " + std::string(word_for(row.rights)) + " `";
  const bool is_of_object = (row.rights & (Right::lock | Right::describe)) != 0 || member.empty();
  text += is_of_object ? std::string(path) + "`"
                       : std::string(member) + "` of `" + std::string(path) + "`";
  return {ErrorCode::authentication_error, text};
}

bool may_stranger_describe(const ServiceHost& host, std::string_view path) {
  // Of the root anybody is told: connecting in steps needs it.
  if (path == host.name()) return true;
  if (host.requires_user()) return false;
  const auto rights = host.rights();
  return !rights || has_right(rights->of(nullptr, path, {}), Right::describe);
}

}  // namespace rr::service
