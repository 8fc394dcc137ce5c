// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <vector>

#include "runtime/cpp/src/discovery/packets.hpp"

namespace rr::discovery {

/// The nodes of this machine that serve local sockets, by their files (05, section 5), and whose
/// lock says that they live.
std::vector<Announcement> find_local_nodes();

}  // namespace rr::discovery
