// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <sys/socket.h>

#include <cerrno>
#include <cstddef>
#include <system_error>

#include "runtime/cpp/src/platform/address.hpp"
#include "runtime/cpp/src/platform/sockets.hpp"

namespace rr::platform {

/// Why the last call of the system on this thread failed.
inline std::error_code last_error() { return {errno, std::generic_category()}; }

/// What a call that sends or receives, and has returned less than 0, means.
inline std::ptrdiff_t failed_transfer() {
  return errno == EAGAIN || errno == EWOULDBLOCK ? nothing_now : broken;
}

/// As the calls of the system take it.
inline const sockaddr* system(const Address& address) {
  return reinterpret_cast<const sockaddr*>(address.bytes.data());
}

}  // namespace rr::platform
