// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <span>
#include <string_view>

#include "rr/definition.hpp"
#include "rr/reader.hpp"
#include "rr/type.hpp"
#include "rr/writer.hpp"

/// Values of members in entries. Elements are found by name, in any order; others are ignored.
namespace rr::endpoint {

/// Writes one element for each parameter.
void write_values(Writer& writer, std::span<const Parameter> parameters, const void* const* values);

/// Reads one. Throws rr::Error (message_element_not_found, data_type_mismatch, ...).
void read_value(Decoder& decoder, const Entry& entry, std::string_view name, const Type& type,
                void* value);
/// Reads all, into one pointer each. Throws as above.
void read_values(Decoder& decoder, const Entry& entry, std::span<const Parameter> parameters,
                 void* const* values);

/// A string element, if there is one of this name.
bool find_text(Decoder& decoder, const Entry& entry, std::string_view name, std::string_view& text);

}  // namespace rr::endpoint
