// SPDX-License-Identifier: Apache-2.0
#include "runtime/cpp/src/channel/shared_rings.hpp"

#include <bit>
#include <cstring>
#include <new>
#include <type_traits>
#include <utility>

#include "runtime/cpp/src/channel/shared_header.hpp"

namespace rr::channel {
namespace {

using Words = SharedRing::Words;

constexpr std::size_t to_server_at = 0x100;
constexpr std::size_t to_client_at = 0x200;
constexpr std::size_t data_at = SharedHeader::first_data;
static_assert(to_server_at + sizeof(Words) == to_client_at &&
              to_client_at + sizeof(Words) <= HoldPlaces::first &&
              HoldPlaces::first + HoldPlaces::count * sizeof(SlotHolds::Words) <= data_at);
// As the page has them.
static_assert(sizeof(SlotHolds::Words) == 64 && std::is_standard_layout_v<SlotHolds::Words>);

SharedRing ring_at(const platform::SharedMemory& memory, std::size_t words_at, std::size_t place,
                   std::size_t size) {
  std::byte* const bytes = memory.bytes();
  return {std::launder(reinterpret_cast<Words*>(bytes + words_at)), bytes + data_at + place * size,
          size};
}

bool is_ring_size(std::size_t size) {
  return std::has_single_bit(size) && size >= SharedRings::smallest_ring &&
         size <= SharedRings::largest_ring;
}

}  // namespace

std::size_t SharedRings::memory_size(std::size_t ring_size) { return data_at + 2 * ring_size; }

SharedRings::SharedRings(platform::SharedMemory memory, std::size_t ring_size)
    : memory_(std::make_shared<const platform::SharedMemory>(std::move(memory))),
      to_server_(ring_at(*memory_, to_server_at, 0, ring_size)),
      to_client_(ring_at(*memory_, to_client_at, 1, ring_size)) {}

std::shared_ptr<SlotHolds::Words> SharedRings::holds() const {
  std::byte* const place = memory_->bytes() + HoldPlaces::first;
  return {memory_, std::launder(reinterpret_cast<SlotHolds::Words*>(place))};
}

SharedRings SharedRings::make(std::size_t ring_size, platform::Descriptor& handle,
                              std::error_code& error) {
  if (!is_ring_size(ring_size)) {
    error = std::make_error_code(std::errc::invalid_argument);
    return {};
  }
  platform::SharedMemory memory =
      platform::make_shared_memory(memory_size(ring_size), handle, error);
  if (!memory) return {};
  const SharedHeader header = SharedHeader::of(SharedKind::rings, ring_size);
  std::memcpy(memory.bytes(), &header, sizeof header);
  new (memory.bytes() + to_server_at) Words;
  new (memory.bytes() + to_client_at) Words;
  for (std::size_t i = 0; i < HoldPlaces::count; ++i) {
    new (memory.bytes() + HoldPlaces::first + i * sizeof(SlotHolds::Words)) SlotHolds::Words;
  }
  SharedRings rings(std::move(memory), ring_size);
  // The server's reactor watches the bell before the client has the memory.
  rings.to_server_.words->reader.store(RingReader::Steps::watches);
  return rings;
}

SharedRings SharedRings::open(const platform::Descriptor& handle, std::error_code& error) {
  platform::SharedMemory memory =
      platform::map_shared_memory(handle, memory_size(largest_ring), error);
  if (!memory) return {};
  const auto header = SharedHeader::read(memory);
  const bool is_right = header.is_of(SharedKind::rings) && is_ring_size(header.area_size) &&
                        memory.size() == memory_size(header.area_size);
  if (!is_right) {
    error = std::make_error_code(std::errc::invalid_argument);
    return {};
  }
  return {std::move(memory), header.area_size};
}

}  // namespace rr::channel
