// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <cstddef>
#include <cstdint>
#include <string_view>

#include "rr/reader.hpp"
#include "rr/writer.hpp"

/// Packets of pipes and their acknowledgements as elements of entries (07, section 11).
namespace rr::endpoint {

/// Metadata of what belongs to an unreliable endpoint: of its messages, and of the entries of
/// packets.
inline constexpr std::string_view unreliable_metadata = "unreliable\n";

/// One packet as it lies in an entry.
struct PipePacket {
  std::int32_t index = 0;
  std::uint32_t number = 0;
  bool asks_acknowledgement = false;
  Element value;
  std::size_t size = 0;  ///< bytes of the whole element
};

/// Writes the element of a packet, of which write_value() writes the value: an element `packet`.
template <class Write>
void write_packet(Writer& writer, std::string_view index, std::uint32_t number,
                  bool asks_acknowledgement, const Write& write_value) {
  const std::size_t end = writer.position();
  const auto write_number = [&](std::string_view name, std::uint32_t value) {
    const std::size_t value_end = writer.position();
    writer.prepend_bytes(&value, sizeof value);
    writer.element(name, ElementType::uint32, {}, 1, value_end);
  };
  if (asks_acknowledgement) write_number("requestack", 1);
  write_value();
  write_number("packetnumber", number);
  writer.element(index, ElementType::dictionary, {}, asks_acknowledgement ? 3 : 2, end);
}

/// Writes the element of an acknowledgement.
void write_acknowledgement(Writer& writer, std::int32_t index, std::uint32_t number);

/// Goes through the packets of an entry; what is none is passed over.
class PipePacketReader {
 public:
  PipePacketReader(Decoder& decoder, const Entry& entry)
      : decoder_(&decoder), elements_(decoder, entry.elements, entry.element_count) {}
  bool next(PipePacket& packet);

 private:
  Decoder* decoder_;
  ElementReader elements_;
};

/// The number of a single item of a uint32 element; false when it is something else.
bool read_number(const Element& element, std::uint32_t& number);

}  // namespace rr::endpoint
