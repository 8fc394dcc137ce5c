// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <cstddef>
#include <cstdint>
#include <span>

#include "rr/visibility.hpp"

namespace RR_VISIBLE rr {

/// CRC-32 with the polynomial 0x04C11DB7, reflected, from and to all ones: that of IEEE 802.3.
/// `sum` is that of the bytes before, 0 for none. Allocates nothing.
[[nodiscard]] std::uint32_t crc32(std::span<const std::byte> bytes, std::uint32_t sum = 0);

}  // namespace rr
