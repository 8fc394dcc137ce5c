// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <stdexcept>
#include <string>
#include <system_error>

#include "rr/discovery.hpp"
#include "runtime/cpp/src/platform/datagrams.hpp"
#include "runtime/cpp/src/platform/interfaces.hpp"

namespace rr::discovery {

/// A discovery that only this test takes part in: broadcasts on the loopback interface, at a port
/// that is free.
inline DiscoveryNetwork loopback_network() {
  for (const platform::LocalAddress& own : platform::local_addresses()) {
    if (own.is_v6() || !own.is_loopback()) continue;
    std::error_code error;
    const platform::Descriptor socket =
        platform::open_datagrams(platform::any_address(platform::Family::v4, 0), {}, error);
    return {.link_local = false,
            .ipv4_broadcast = true,
            .interfaces = {own.interface},
            .port = platform::local_address(socket.get()).port()};
  }
  throw std::runtime_error("there is no loopback interface");
}

/// Listens there, to nothing else.
inline ListenOptions listening_at(const DiscoveryNetwork& network) {
  return {.network = network, .local = false};
}

}  // namespace rr::discovery
