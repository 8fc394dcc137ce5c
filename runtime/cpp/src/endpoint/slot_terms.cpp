// SPDX-License-Identifier: Apache-2.0
#include "runtime/cpp/src/endpoint/slot_terms.hpp"

#include <cstring>

namespace rr::endpoint {
namespace {

// One number of that type; 0 and false when it is something else.
template <class T>
bool find_number(Decoder& decoder, const Entry& entry, std::string_view name, ElementType type,
                 T& value) {
  Element element;
  if (!find_element(decoder, entry.elements, entry.element_count, name, element) ||
      element.type != type || element.payload.size() != sizeof value) {
    return false;
  }
  std::memcpy(&value, element.payload.data(), sizeof value);
  return true;
}

}  // namespace

std::optional<SlotMode> find_slot_mode(Decoder& decoder, const Entry& entry,
                                       std::string_view name) {
  std::uint32_t mode = 0;
  if (!find_number(decoder, entry, name, ElementType::uint32, mode)) return std::nullopt;
  if (mode > static_cast<std::uint32_t>(SlotMode::woken)) return std::nullopt;
  return static_cast<SlotMode>(mode);
}

std::uint64_t find_slots(Decoder& decoder, const Entry& entry) {
  std::uint64_t id = 0;
  const bool is_there = find_number(decoder, entry, slots_element, ElementType::uint64, id);
  return is_there ? id : 0;
}

void write_slots(Writer& writer, std::uint64_t id) {
  const std::size_t end = writer.position();
  writer.prepend_bytes(&id, sizeof id);
  writer.element(slots_element, ElementType::uint64, {}, 1, end);
}

}  // namespace rr::endpoint
