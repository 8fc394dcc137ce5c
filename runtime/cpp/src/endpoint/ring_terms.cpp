// SPDX-License-Identifier: Apache-2.0
#include "runtime/cpp/src/endpoint/ring_terms.hpp"

#include <array>
#include <cstddef>
#include <cstring>

namespace rr::endpoint {
namespace {

// So many numbers of that type; false when it is something else.
template <class T, std::size_t count>
bool find_numbers(Decoder& decoder, const Entry& entry, std::string_view name, ElementType type,
                  std::array<T, count>& values) {
  Element element;
  if (!find_element(decoder, entry.elements, entry.element_count, name, element) ||
      element.type != type || element.payload.size() != sizeof values) {
    return false;
  }
  std::memcpy(values.data(), element.payload.data(), sizeof values);
  return true;
}

template <class T, std::size_t count>
void write_numbers(Writer& writer, std::string_view name, ElementType type,
                   const std::array<T, count>& values) {
  const std::size_t end = writer.position();
  writer.prepend_bytes(values.data(), sizeof values);
  writer.element(name, type, {}, count, end);
}

}  // namespace

std::optional<RingWish> find_ring_wish(Decoder& decoder, const Entry& entry,
                                       std::string_view name) {
  std::array<std::uint32_t, 1> wish{};
  if (!find_numbers(decoder, entry, name, ElementType::uint32, wish)) return std::nullopt;
  if (wish[0] > static_cast<std::uint32_t>(RingWish::ring)) return std::nullopt;
  return static_cast<RingWish>(wish[0]);
}

channel::PipeRingStart find_ring(Decoder& decoder, const Entry& entry) {
  std::array<std::uint64_t, 6> numbers{};
  if (!find_numbers(decoder, entry, ring_element, ElementType::uint64, numbers)) return {};
  return {numbers[0], numbers[1], numbers[2], numbers[3], numbers[4], numbers[5]};
}

void write_ring(Writer& writer, const channel::PipeRingStart& start) {
  const std::array<std::uint64_t, 6> numbers{start.id,    start.position, start.number,
                                             start.place, start.turn,     start.reader};
  write_numbers(writer, ring_element, ElementType::uint64, numbers);
}

std::optional<std::int32_t> find_ring_notice(Decoder& decoder, const Entry& entry) {
  std::array<std::uint32_t, 1> index{};
  if (entry.element_count != 1) return std::nullopt;
  if (!find_numbers(decoder, entry, ring_element, ElementType::uint32, index)) return std::nullopt;
  return static_cast<std::int32_t>(index[0]);
}

void write_ring_notice(Writer& writer, std::int32_t index) {
  const std::array<std::uint32_t, 1> numbers{static_cast<std::uint32_t>(index)};
  write_numbers(writer, ring_element, ElementType::uint32, numbers);
}

}  // namespace rr::endpoint
