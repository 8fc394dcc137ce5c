// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <cstddef>
#include <cstdint>
#include <deque>
#include <utility>

#include "rr/buffer.hpp"

namespace rr::endpoint {

/// What a client was to read in the ring of a pipe, and has to get by messages now: elements
/// `packet` of format 4, in their order.
struct MissedPackets {
  struct Packet {
    MemoryRef owner;
    const std::byte* bytes = nullptr;
    std::size_t size = 0;
  };
  std::uint64_t read = 0;  ///< packets that it has read there, as it says
  std::deque<Packet> packets;
  bool is_lost = false;      ///< they cannot be had: the endpoint must end
  bool is_notified = false;  ///< the client has the notice that it is in no ring
};

}  // namespace rr::endpoint
