// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <cstdint>
#include <optional>
#include <string_view>

#include "rr/reader.hpp"
#include "rr/writer.hpp"
#include "runtime/cpp/src/channel/pipe_ring.hpp"

/// What client and service say of the ring of a pipe (docs/reference/shared_memory.md).
namespace rr::endpoint {

/// In a PipeConnectReq: an uint32, the RingWish. In the answer, and in one to `ring_again_element`:
/// six uint64, a PipeRingStart in the order of its members; without it, packets come as messages.
/// In an entry of packets: an uint32, the index of an endpoint whose client is to look at its ring.
inline constexpr std::string_view ring_element = "robdef.ring";
/// The RingWish in a PipeConnectReq for an endpoint that is connected.
inline constexpr std::string_view ring_again_element = "robdef.ring_again";

/// How a client wants packets that are sent to all.
enum class RingWish : std::uint32_t {
  messages = 0,
  ring = 1,
};

/// A wish of that name; nothing when there is none, or none that is known.
[[nodiscard]] std::optional<RingWish> find_ring_wish(Decoder& decoder, const Entry& entry,
                                                     std::string_view name);

/// What an answer says; its `id` is 0 when it says nothing.
[[nodiscard]] channel::PipeRingStart find_ring(Decoder& decoder, const Entry& entry);
/// Writes it: one element.
void write_ring(Writer& writer, const channel::PipeRingStart& start);

/// The endpoint whose client is to look at its ring, as an entry of packets says; nothing when it
/// has packets.
[[nodiscard]] std::optional<std::int32_t> find_ring_notice(Decoder& decoder, const Entry& entry);
/// Writes it: one element.
void write_ring_notice(Writer& writer, std::int32_t index);

}  // namespace rr::endpoint
