// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <array>
#include <cstddef>
#include <cstdint>
#include <cstring>
#include <type_traits>

#include "runtime/cpp/src/platform/shared_memory.hpp"

namespace rr::channel {

/// What a memory is used for, by the number in its header.
enum class SharedKind : std::uint32_t {
  rings = 1,
  slots = 2,
  packets = 3,
};

/// What is at the beginning of each memory that nodes share, written once, before anybody else has
/// it (docs/reference/shared_memory.md).
struct SharedHeader {
  std::array<char, 8> magic;
  std::uint32_t version;
  SharedKind kind;
  std::uint32_t area_size;   ///< bytes of a ring, or of a slot
  std::uint32_t data_at;     ///< where the first one begins
  std::uint32_t area_count;  ///< of slots; 1 for packets; 0 for rings
  std::uint32_t unused;
  std::uint64_t id;  ///< of slots and packets; 0 for rings

  /// Where that is in all kinds.
  static constexpr std::size_t first_data = 0x1000;

  static SharedHeader of(SharedKind kind, std::size_t area_size) {
    return {
        {'R', 'R', 'S', 'H', 'A', 'R', 'E', 'D'}, 1, kind, static_cast<std::uint32_t>(area_size),
        static_cast<std::uint32_t>(first_data),   0, 0,    0};
  }
  /// A copy of what is in a memory; one of zeros when that is too small.
  static SharedHeader read(const platform::SharedMemory& memory) {
    SharedHeader header{};
    if (memory.size() >= first_data) std::memcpy(&header, memory.bytes(), sizeof header);
    return header;
  }
  /// Whether it is as of() makes it, whatever its sizes are.
  [[nodiscard]] bool is_of(SharedKind wanted) const {
    const SharedHeader right = of(wanted, 0);
    return magic == right.magic && version == right.version && kind == right.kind &&
           data_at == right.data_at;
  }
};
static_assert(sizeof(SharedHeader) == 40 && std::is_trivially_copyable_v<SharedHeader>);

}  // namespace rr::channel
