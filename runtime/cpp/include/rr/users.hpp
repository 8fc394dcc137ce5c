// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <algorithm>
#include <map>
#include <memory>
#include <string>
#include <string_view>
#include <vector>

#include "rr/node_id.hpp"
#include "rr/varvalue.hpp"
#include "rr/visibility.hpp"

/// Who may use a service (07, section 6).
namespace RR_VISIBLE rr {

/// The privilege to lock objects.
inline constexpr std::string_view lock_privilege = "objectlock";
/// The privilege to end locks of other users.
inline constexpr std::string_view override_lock_privilege = "objectlockoverride";

/// A user that a service has recognised.
struct User {
  std::string name;                       ///< as in the log and in rules
  std::vector<std::string> privileges{};  ///< also the roles that rules of Rights name

  /// Whether the user has a privilege.
  [[nodiscard]] bool has(std::string_view privilege) const {
    return std::find(privileges.begin(), privileges.end(), privilege) != privileges.end();
  }
};

/// Recognises users: given to a service with ServiceOptions::users.
class Users {
 public:
  virtual ~Users() = default;
  /// Called on a thread that does nothing but this (NodeOptions::login says how many there are), so
  /// it may take its time; several clients at once where there are several threads. The client's
  /// other requests wait until it returns. `credentials` are what the client gives, usually
  /// `password`; `node` is what it says of itself. Throws rr::Error (authentication_error) for
  /// a user that is not to be let in.
  [[nodiscard]] virtual User authenticate(const std::string& name,
                                          const std::map<std::string, VarValue>& credentials,
                                          const NodeId& node) const = 0;
  /// Warnings for the operator of the service; they go to the log when it is registered.
  [[nodiscard]] virtual std::vector<std::string> warnings() const { return {}; }
};

/// Users with passwords, one a line; `#` begins a comment:
///
///   alice $y$j9T$... objectlock,objectlockoverride
///   bob   $y$j9T$... _ {a1b2c3d4-1111-4222-8333-444455556666}
///
/// Name, hash, privileges (`_` for none), and, if the user may come from certain nodes only, their
/// ids. Hashes are those of crypt(5), made by hash() or `mkpasswd -m yescrypt`. The hashes of
/// existing files, 32 digits of an MD5 without salt, are taken with a warning: a reader of the
/// file finds out such passwords.
class PasswordUsers final : public Users {
 public:
  /// Throws rr::Error (invalid_configuration), naming the line.
  explicit PasswordUsers(std::string_view text);
  /// Throws as well when the file cannot be read.
  static std::shared_ptr<PasswordUsers> from_file(const std::string& path);
  ~PasswordUsers() override;

  /// A hash for a line, with a random salt: yescrypt; on Windows SHA-512. Throws rr::Error:
  /// invalid_argument for a password that has a NUL or more than 511 bytes.
  static std::string hash(std::string_view password);

  [[nodiscard]] User authenticate(const std::string& name,
                                  const std::map<std::string, VarValue>& credentials,
                                  const NodeId& node) const override;
  [[nodiscard]] std::vector<std::string> warnings() const override;

 private:
  struct Account;
  std::vector<Account> accounts_;
};

}  // namespace rr
