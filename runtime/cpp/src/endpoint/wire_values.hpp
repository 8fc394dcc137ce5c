// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <cstdint>
#include <string_view>

#include "rr/buffer.hpp"
#include "rr/definition.hpp"
#include "rr/reader.hpp"
#include "rr/registry.hpp"
#include "rr/time_spec.hpp"
#include "rr/type.hpp"
#include "rr/writer.hpp"

/// Values of wires in entries: the elements `packettime` and `packet` (07, section 13).
namespace rr::endpoint {

/// Metadata of packets that may be lost, in the entry and in the message header.
inline constexpr std::string_view unreliable_mark = "unreliable\n";

inline constexpr std::uint32_t wire_elements = 2;

/// Writes a value alone; the time follows, since elements are written last first. Throws rr::Error
/// (data_type_error, ...) for what may not travel.
void write_wire_value(Writer& writer, const Type& type, const void* value);
void write_wire_time(Writer& writer, const TimeSpec& time);

/// Throws rr::Error (message_element_not_found, data_type_mismatch, ...).
void read_wire(const Message& message, const Entry& entry, const MemoryRef& owner,
               const TypeRegistry& types, const Type& type, TimeSpec& time, void* value);
void read_wire(Decoder& decoder, const Entry& entry, const Type& type, TimeSpec& time, void* value);

/// The request that sets a value, as if the two elements were its parameters.
struct WireParameters {
  WireParameters(const Type& type, const TimeSpec& time, const void* value)
      : parameters{{"packettime", &type_of<TimeSpec>}, {"packet", &type}}, values{&time, value} {}

  const Parameter parameters[wire_elements];
  const void* const values[wire_elements];
};

}  // namespace rr::endpoint
