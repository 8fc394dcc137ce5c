// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <cstdint>
#include <string>
#include <string_view>

namespace rr::replay {

/// A TCP port of a host.
struct HostPort {
  std::string host;
  std::uint16_t port = 0;
};

/// `HOST:PORT`, `[V6]:PORT` or the URL of a service. Throws rr::Error (invalid_argument).
HostPort host_port_of(std::string_view text);

}  // namespace rr::replay
