// SPDX-License-Identifier: Apache-2.0
#pragma once

#include "runtime/cpp/src/platform/sockets.hpp"

namespace rr::platform {

/// A new socket of AF_... and SOCK_... that never waits, and that programs started from here do not
/// get. None, with the reason in WSAGetLastError().
Descriptor open_socket(int family, int kind);

}  // namespace rr::platform
