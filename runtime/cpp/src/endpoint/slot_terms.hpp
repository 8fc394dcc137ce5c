// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <cstdint>
#include <optional>
#include <string_view>

#include "rr/reader.hpp"
#include "rr/writer.hpp"

/// What client and service say of the slots of a wire, in its WireConnectReq and the answer
/// (docs/reference/shared_memory.md).
namespace rr::endpoint {

/// In a request that connects a wire: an uint32, the SlotMode. In the answer: an uint64, the number
/// of the memory; without it, values come as messages.
inline constexpr std::string_view slots_element = "robdef.slots";
/// The same in a request that changes how values of a connected wire come.
inline constexpr std::string_view slots_again_element = "robdef.slots_again";

/// How a client wants the values of a wire.
enum class SlotMode : std::uint32_t {
  messages = 0,
  polled = 1,  ///< by slots; it looks when it likes
  woken = 2,   ///< by slots; it sleeps until there is one
};

/// A mode of that name; nothing when there is none, or none that is known.
[[nodiscard]] std::optional<SlotMode> find_slot_mode(Decoder& decoder, const Entry& entry,
                                                     std::string_view name);
/// The number of the memory in an answer; 0: none.
[[nodiscard]] std::uint64_t find_slots(Decoder& decoder, const Entry& entry);
/// Writes that number as an element.
void write_slots(Writer& writer, std::uint64_t id);

}  // namespace rr::endpoint
