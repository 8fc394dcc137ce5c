// SPDX-License-Identifier: Apache-2.0
#include "runtime/cpp/src/endpoint/pipe_packets.hpp"

#include <cstring>

namespace rr::endpoint {
namespace {

[[gnu::hot]] bool read_packet(Decoder& decoder, const Element& element, PipePacket& packet) {
  if (element.type != ElementType::dictionary) return false;
  ElementReader members(decoder, element);
  bool has_number = false;
  bool has_value = false;
  packet.asks_acknowledgement = false;
  packet.size = element.payload.size();
  for (Element member; members.next(member);) {
    if (member.name == "packetnumber") {
      has_number = read_number(member, packet.number);
    } else if (member.name == "packet") {
      has_value = true;
      packet.value = member;
    } else if (member.name == "requestack") {
      packet.asks_acknowledgement = true;
    }
  }
  return has_number && has_value;
}

}  // namespace

// By number in format 4, by name in format 2.
void write_acknowledgement(Writer& writer, std::int32_t index, std::uint32_t number) {
  const std::size_t end = writer.position();
  writer.prepend_bytes(&number, sizeof number);
  writer.element(ElementName(index), ElementType::uint32, {}, 1, end);
}

[[gnu::hot]] bool PipePacketReader::next(PipePacket& packet) {
  for (Element element; elements_.next(element);) {
    const auto index = element.index();
    if (!index) continue;
    packet.index = *index;
    if (read_packet(*decoder_, element, packet)) return true;
  }
  return false;
}

[[gnu::hot]] bool read_number(const Element& element, std::uint32_t& number) {
  if (element.type != ElementType::uint32 || element.count != 1 ||
      element.payload.size() != sizeof number) {
    return false;
  }
  std::memcpy(&number, element.payload.data(), sizeof number);
  return true;
}

}  // namespace rr::endpoint
