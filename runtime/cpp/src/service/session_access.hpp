// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <atomic>
#include <cstdint>
#include <memory>
#include <string_view>

#include "rr/error.hpp"
#include "rr/mutex.hpp"
#include "rr/rights.hpp"
#include "rr/users.hpp"
#include "rr/wire.hpp"
#include "runtime/cpp/src/service/access_table.hpp"
#include "runtime/cpp/src/service/grants.hpp"

namespace rr::service {

class ServiceHost;

/// Who uses a session, and what that allows: the one place that says whether an entry of the
/// session may be handled, and whether the service may send it something. Used by any thread; calls
/// nothing of the program.
class SessionAccess {
 public:
  /// A session begins: nobody is logged in.
  void open(const ServiceHost& host);
  /// It is over.
  void close();

  /// Changes with whatever may change an answer of this class: who has it unchanged need not ask
  /// again. Never 0 in a session.
  [[nodiscard]] std::uint32_t standing() const { return standing_.load(std::memory_order_acquire); }
  /// Changes when what the session has opened is not to be used any more, because another user, or
  /// nobody, is logged in.
  [[nodiscard]] std::uint32_t login() const { return login_.load(std::memory_order_acquire); }

  /// Who is logged in; null for nobody.
  [[nodiscard]] std::shared_ptr<const User> user() const;
  /// Logs in. Returns the user whose things are open then, if that is another one.
  std::shared_ptr<const User> log_in(std::shared_ptr<const User> user);
  /// Returns who was logged in; null for nobody.
  std::shared_ptr<const User> log_out();
  /// Takes the rules of the service as they are now. False when they are the same ones.
  bool renew_rights(const ServiceHost& host);

  /// Throws rr::Error (authentication_error) when an entry from the client may not be handled.
  void check(EntryType type, std::string_view path, std::string_view member) const {
    check(row_of_received(type, member), path, member);
  }
  void check(const AccessRow& row, std::string_view path, std::string_view member) const;
  [[nodiscard]] bool may_receive(EntryType type, std::string_view path,
                                 std::string_view member) const {
    return allows(row_of_received(type, member), path, member);
  }
  /// Whether the service may send this to the client.
  [[nodiscard]] bool may_send(EntryType type, std::string_view path,
                              std::string_view member) const {
    return allows(row_of_sent(type), path, member);
  }
  [[nodiscard]] bool allows(const AccessRow& row, std::string_view path,
                            std::string_view member) const;
  [[nodiscard]] bool has_rules() const { return (standing() & ruled) != 0; }
  /// Whether the service has neither users nor rules: nobody is refused anything.
  [[nodiscard]] bool is_open_to_all() const;
  /// What the rules say; all rights without any.
  [[nodiscard]] RightSet rights_of(std::string_view path, std::string_view member) const;

  /// What is said to who lacks a right.
  [[nodiscard]] Error refusal(const AccessRow& row, std::string_view path,
                              std::string_view member) const;

 private:
  // Bits of the standing; the rest counts.
  static constexpr std::uint32_t connected = 1;
  static constexpr std::uint32_t admitted = 2;  // logged in, or does not have to be
  static constexpr std::uint32_t known = 4;     // logged in, or there are no users
  static constexpr std::uint32_t ruled = 8;     // there are rules
  static constexpr std::uint32_t count = 16;

  [[nodiscard]] static bool suffices(const AccessRow& row, std::uint32_t standing);
  [[nodiscard]] std::shared_ptr<const Grants> grants() const;
  void renew() RR_REQUIRES(mutex_);

  std::atomic<std::uint32_t> standing_{0};
  std::atomic<std::uint32_t> login_{0};

  mutable Mutex mutex_;
  bool is_open_ RR_GUARDED_BY(mutex_) = false;
  bool has_users_ RR_GUARDED_BY(mutex_) = false;
  bool requires_user_ RR_GUARDED_BY(mutex_) = false;
  std::shared_ptr<const User> user_ RR_GUARDED_BY(mutex_);
  std::shared_ptr<const Rights> rights_ RR_GUARDED_BY(mutex_);
  std::shared_ptr<const Grants> grants_ RR_GUARDED_BY(mutex_);  // null without rules
};

/// Whether somebody who is not connected may ask for the type of an object.
bool may_stranger_describe(const ServiceHost& host, std::string_view path);

}  // namespace rr::service
