// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <string>
#include <vector>

#include "runtime/cpp/src/channel/socket.hpp"

namespace rr::discovery {

/// An address of this machine, on an interface that is up.
struct LocalAddress {
  channel::Address address;  ///< without a port
  std::string interface;
  unsigned interface_number = 0;

  [[nodiscard]] bool is_v6() const { return address.family() == AF_INET6; }
  [[nodiscard]] bool is_loopback() const;
  [[nodiscard]] bool is_link_local() const;
  /// `10.0.0.5`, `[fe80::1]`: as the host of a URL, without a scope.
  [[nodiscard]] std::string host() const;
};

/// All of them as they are now; empty when the system does not tell.
std::vector<LocalAddress> local_addresses();

/// Where somebody who listens at `base` (`rr+tcp://0.0.0.0:6257`) may be reached, without scopes:
/// any-addresses stand for all addresses of their family.
std::vector<std::string> reachable_urls(const std::string& base,
                                        const std::vector<LocalAddress>& addresses);

}  // namespace rr::discovery
