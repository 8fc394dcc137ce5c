// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <string>
#include <vector>

#include "runtime/cpp/src/platform/address.hpp"

namespace rr::platform {

/// An address of this machine, on an interface that is up.
struct LocalAddress {
  Address address;  ///< without a port
  std::string interface;
  unsigned interface_number = 0;

  [[nodiscard]] bool is_v6() const { return address.family() == Family::v6; }
  [[nodiscard]] bool is_loopback() const;
  [[nodiscard]] bool is_link_local() const;
  /// `10.0.0.5`, `[fe80::1]`: as the host of a URL, without a scope.
  [[nodiscard]] std::string host() const;
};

/// All of them as they are now; empty when the system does not tell.
std::vector<LocalAddress> local_addresses();

}  // namespace rr::platform
