// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <functional>
#include <string>
#include <vector>

#include "rr/discovery.hpp"
#include "runtime/cpp/src/discovery/interfaces.hpp"

namespace rr::discovery {

/// Sends the packets that `packets_for` gives for each address of this machine from there, to the
/// groups of the network and, if it is used, to all of IPv4 (05, section 1). What cannot be sent is
/// left out: a link may be down.
void send_from_all(
    const DiscoveryNetwork& network,
    const std::function<std::vector<std::string>(const LocalAddress& from)>& packets_for);

}  // namespace rr::discovery
