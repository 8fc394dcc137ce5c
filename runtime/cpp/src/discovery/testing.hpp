// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <netinet/in.h>
#include <sys/socket.h>

#include <chrono>

#include "rr/discovery.hpp"
#include "runtime/cpp/src/channel/socket.hpp"

namespace rr::discovery {

/// A discovery that only this test takes part in: broadcasts on the loopback interface, at a port
/// that is free.
inline DiscoveryNetwork loopback_network() {
  const channel::Descriptor socket(::socket(AF_INET, SOCK_DGRAM | SOCK_CLOEXEC, 0));
  sockaddr_in any{};
  any.sin_family = AF_INET;
  static_cast<void>(::bind(socket.get(), reinterpret_cast<const sockaddr*>(&any), sizeof any));
  return {.link_local = false,
          .ipv4_broadcast = true,
          .interfaces = {"lo"},
          .port = platform::local_address(socket.get()).port()};
}

/// Listens there, to nothing else.
inline ListenOptions listening_at(const DiscoveryNetwork& network) {
  return {.network = network, .local = false};
}

}  // namespace rr::discovery
