// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <string>
#include <vector>

#include "runtime/cpp/src/platform/interfaces.hpp"

namespace rr::discovery {

using platform::local_addresses;
using platform::LocalAddress;

/// Where somebody who listens at `base` (`rr+tcp://0.0.0.0:6257`) may be reached, without scopes:
/// any-addresses stand for all addresses of their family.
std::vector<std::string> reachable_urls(const std::string& base,
                                        const std::vector<LocalAddress>& addresses);

}  // namespace rr::discovery
