// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <windows.h>

#include "runtime/cpp/src/platform/users.hpp"

namespace rr::platform {

/// Users of Windows have long names, security identifiers; each gets a number that is this
/// process's own. The system and its administrators are system_user.
UserId number_of(PSID user);
/// The user that a process's token is of; nothing when it cannot be asked.
std::optional<UserId> user_of_process(HANDLE process);

}  // namespace rr::platform
