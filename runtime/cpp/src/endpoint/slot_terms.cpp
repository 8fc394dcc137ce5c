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

template <class T>
void write_number(Writer& writer, std::string_view name, ElementType type, T value) {
  const std::size_t end = writer.position();
  writer.prepend_bytes(&value, sizeof value);
  writer.element(name, type, {}, 1, end);
}

}  // namespace

std::optional<SlotMode> find_slot_mode(Decoder& decoder, const Entry& entry,
                                       std::string_view name) {
  std::uint32_t mode = 0;
  if (!find_number(decoder, entry, name, ElementType::uint32, mode)) return std::nullopt;
  if (mode > static_cast<std::uint32_t>(SlotMode::woken)) return std::nullopt;
  return static_cast<SlotMode>(mode);
}

SlotTerms find_slots(Decoder& decoder, const Entry& entry) {
  SlotTerms terms;
  if (!find_number(decoder, entry, slots_element, ElementType::uint64, terms.id)) return {};
  std::uint32_t holds = 0;
  if (find_number(decoder, entry, holds_element, ElementType::uint32, holds)) terms.holds = holds;
  return terms;
}

std::uint32_t write_slots(Writer& writer, const SlotTerms& terms) {
  if (terms.holds) write_number(writer, holds_element, ElementType::uint32, *terms.holds);
  write_number(writer, slots_element, ElementType::uint64, terms.id);
  return terms.holds ? 2 : 1;
}

}  // namespace rr::endpoint
