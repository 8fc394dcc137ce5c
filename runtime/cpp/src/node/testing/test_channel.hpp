// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <cstdint>
#include <string>

#include "rr/node.hpp"

namespace rr::testing {

/// The channel that pairs of nodes use in a run of the tests: that of the variable
/// ROBDEF_TEST_CHANNEL, one of tcp, local, shm, intra, ws, tls, wss, and tcp without it.
std::string test_channel();

/// A folder of this process, made on demand and removed at its end.
std::string test_folder();

/// What a node needs to use the channel, added to other options.
NodeOptions with_channel(NodeOptions options, const std::string& channel = test_channel());

/// Makes a node listen by the channel. Returns what its URLs begin with, up to and with the `?`,
/// and other parameters with their `&`.
std::string listen_by_channel(Node& node, std::uint16_t& port,
                              const std::string& channel = test_channel());

}  // namespace rr::testing
