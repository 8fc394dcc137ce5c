// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <cstdint>
#include <optional>
#include <string>

#include "rr/visibility.hpp"

namespace rr::platform {

/// A user of this machine, as numbers of the system.
using UserId = std::uint32_t;
/// The user that the system itself runs as.
inline constexpr UserId system_user = 0;

struct Account {
  std::string name;  ///< empty when the user has none
  std::string home;  ///< a folder; empty when there is none
};

/// Whom the process acts for.
UserId current_user();
Account current_account();
/// The user that a name belongs to.
std::optional<UserId> user_of(const std::string& name);
/// To whom a file or a folder belongs, links followed. Nothing when it cannot be looked at.
std::optional<UserId> owner_of(const std::string& path);

/// Another one for each process that runs.
std::uint64_t process_id();
/// The name of this machine, without or with its domain; empty when it has none.
RR_INSIDE std::string machine_name();

}  // namespace rr::platform
