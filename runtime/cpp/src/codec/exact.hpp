// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <cstdint>
#include <span>
#include <string_view>

#include "rr/reader.hpp"
#include "rr/writer.hpp"

/// Writes headers as they were received: in format 4 with exactly the fields that their flags
/// announce, string codes among them. The ordinary functions of Writer choose the flags themselves.
/// All of them write backwards, like Writer.
namespace rr::codec {

/// An entry of a message's own string table.
struct StringCode {
  std::uint32_t code = 0;
  std::string_view text;
};

/// `element.payload` is not looked at: it was written since position() was `end`.
void write_element_header(Writer& writer, const Element& element, std::size_t end);
void write_entry_header(Writer& writer, const Entry& entry, std::size_t end);
void write_message_header(Writer& writer, const Message& message,
                          std::span<const StringCode> strings);

}  // namespace rr::codec
