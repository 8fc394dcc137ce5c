// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <cstddef>
#include <cstdint>

#include "rr/wire.hpp"

namespace rr {

/// Takes `data` for a message, its first ten bytes made right, and aborts when the codec breaks a
/// promise: what is accepted can be walked to the end and survives being written and read again.
void fuzz_message(const std::uint8_t* data, std::size_t size, MessageVersion version);

}  // namespace rr
