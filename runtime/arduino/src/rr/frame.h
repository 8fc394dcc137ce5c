// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <stdint.h>

#include "protocol.h"

/// Frames in the memory of a link.
namespace rr {

/// Over kind to the end of the body; 0 over a good frame with its CRC.
uint16_t crcOver(const uint8_t* bytes, uint8_t count);

/// Where the body is in the memory of a frame to be sent: behind the code of the first block, kind,
/// sequence number and length.
constexpr uint8_t sentBodyAt = 4;

/// Makes a frame around the body that is in its place, ready to be sent: stuffed, and with the zero
/// after it. `frame` has room for the body, the overhead and `stuffing`.
void finishFrame(uint8_t* frame, serial::Kind kind, uint8_t sequence, uint8_t length);

}  // namespace rr
