// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <map>
#include <set>
#include <string>
#include <string_view>
#include <vector>

#include "gateway/export_file.hpp"

/// What brokers have to allow so that robots and their users can do what export files list, and no
/// more.
namespace rr::gateway {

/// Topics, with `+` and `#` as filters have them.
struct AccessRights {
  std::set<std::string> publish;  ///< may publish there
  std::set<std::string> receive;  ///< gets what others publish there
};

/// Stands for the name of the user, in topics for everybody.
inline constexpr std::string_view any_user = "%u";

/// Rights of the users of a broker.
struct AccessList {
  /// Of any user, whose name stands in topics as `%u`.
  AccessRights everybody;
  /// Of single users, by name: the robots, and users that rules name.
  std::map<std::string, AccessRights> users;
};

/// The rights that export files ask for. A pattern of members with letters beside its `*` gives the
/// right to all members of these objects: brokers know no such patterns, and the gateway of the
/// robot refuses the others. Throws rr::Error (invalid_configuration) for a file without
/// `broker.user`, and for two robots with one user.
AccessList access_list(const std::vector<ExportFile>& files);

/// The list as an `acl_file` of mosquitto.
std::string mosquitto_acl(const AccessList& list);

/// The list as an `authorization` block of a server of NATS. It has no rights for any user, so
/// everybody is the users of the list and `others`. Those in `watchers` also see the whole fleet,
/// for which a user of mosquitto needs no right of its own. The password of user `eve` is the
/// variable `$password_eve`, which the file `passwords.conf` beside it has. Throws rr::Error
/// (invalid_configuration) for a user with other letters than names in topics have.
std::string nats_authorization(const AccessList& list, const std::vector<std::string>& others,
                               const std::vector<std::string>& watchers = {});

}  // namespace rr::gateway
