// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <cstddef>
#include <cstdint>
#include <optional>
#include <string>
#include <string_view>

#include "rr/node_id.hpp"
#include "runtime/cpp/src/channel/socket.hpp"

/// The two packets of discovery: text, one in a datagram (05, section 2).
namespace rr::discovery {

/// Where all of them go, and come from.
inline constexpr std::uint16_t discovery_port = 48653;
/// A longer datagram is cut here.
inline constexpr std::size_t longest_packet = 8192;
inline constexpr std::size_t longest_url = 256;

/// What a node says of itself: one way to reach its service index.
struct Announcement {
  NodeId node;
  std::string name{};   ///< empty for none
  std::string url{};    ///< of the service index
  std::string nonce{};  ///< another one when its services have changed; empty for none
};

std::string write_announcement(const Announcement& announcement);
/// Nothing unless all that a receiver has to check holds (05, section 4), but for whose it is: the
/// sender's address counts, too.
std::optional<Announcement> read_announcement(std::string_view packet,
                                              const channel::Address& sender);

/// Asks all nodes to announce themselves. `asker` is a random id, by which who asks knows its own.
std::string write_request(const NodeId& asker);
/// Who asks. Nothing when it is no such packet, or says it without a valid id.
std::optional<NodeId> read_request(std::string_view packet);

}  // namespace rr::discovery
