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
/// In the answer, an uint32: the place of the words by which the client says which slots it uses.
inline constexpr std::string_view holds_element = "robdef.holds";

/// How a client wants the values of a wire.
enum class SlotMode : std::uint32_t {
  messages = 0,
  polled = 1,  ///< by slots; it looks when it likes
  woken = 2,   ///< by slots; it sleeps until there is one
};

/// A mode of that name; nothing when there is none, or none that is known.
[[nodiscard]] std::optional<SlotMode> find_slot_mode(Decoder& decoder, const Entry& entry,
                                                     std::string_view name);
/// What the service answers.
struct SlotTerms {
  std::uint64_t id = 0;                  ///< the number of the memory; 0: none
  std::optional<std::uint32_t> holds{};  ///< without one, values are copied out of it
};

/// What an answer says.
[[nodiscard]] SlotTerms find_slots(Decoder& decoder, const Entry& entry);
/// Writes it, and returns the number of elements.
std::uint32_t write_slots(Writer& writer, const SlotTerms& terms);

}  // namespace rr::endpoint
