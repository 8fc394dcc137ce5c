// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <cstddef>
#include <cstdint>
#include <span>

#include "rr/tap.hpp"

namespace rr::replay {

/// Tells a tap of a message that passes by, and of what it says of its connection: what was agreed,
/// and definitions.
void tell(Tap& tap, std::uint32_t connection, Direction direction,
          std::span<const std::byte> message);

}  // namespace rr::replay
