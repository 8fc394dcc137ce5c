// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <cstdint>
#include <span>
#include <string_view>

#include "rr/error.hpp"
#include "rr/node_id.hpp"
#include "rr/reader.hpp"
#include "rr/writer.hpp"

/// Messages that a connection sends by itself (04, sections 4 and 5).
namespace rr::channel {

inline constexpr std::string_view create_connection = "CreateConnection";
inline constexpr std::string_view get_remote_node_id = "GetRemoteNodeID";
inline constexpr std::string_view start_tls = "STARTTLS";

// Of this runtime: shared memory (docs/reference/shared_memory.md). A stream capability, whose
// level is the version of the layout, and the operation.
inline constexpr std::string_view shared_memory_capability = "robdef.shared_memory";
inline constexpr std::uint32_t shared_memory_level = 1;
inline constexpr std::string_view share_memory = "robdef.ShareMemory";
// An element of the operation and of its answer: wires may have slots in further memories. What it
// says is the version of their layout.
inline constexpr std::string_view slots_element = "slots";
inline constexpr std::uint32_t slots_level = 1;

/// An array of uint32, before what was written so far.
void write_codes(Writer& writer, std::string_view name, std::span<const std::uint32_t> codes);

/// The element that says that wires may have slots.
void write_slots_level(Writer& writer);
/// Whether an entry has it, and means slots that this runtime knows.
[[nodiscard]] bool has_slots_level(Decoder& decoder, const Entry& entry);

/// The elements `errorname` and `errorstring`; returns how many elements.
std::uint32_t write_error(Writer& writer, std::string_view name, std::string_view message);

/// The first message of a connection, whole, always in format 2.
void write_create_connection(Writer& writer, const MessageHeader& header,
                             std::span<const std::uint32_t> codes);

}  // namespace rr::channel
