// SPDX-License-Identifier: Apache-2.0
#include "frame.h"

namespace rr {

uint16_t crcOver(const uint8_t* bytes, uint8_t count) {
  uint16_t crc = serial::crcStart;
  for (; count != 0; --count) crc = serial::crcOf(crc, *bytes++);
  return crc;
}

void finishFrame(uint8_t* frame, serial::Kind kind, uint8_t sequence, uint8_t length) {
  frame[0] = 0;
  frame[1] = static_cast<uint8_t>(kind);
  frame[2] = sequence;
  frame[3] = length;
  const uint16_t crc = crcOver(frame + 1, static_cast<uint8_t>(length + 3));
  uint8_t* at = frame + sentBodyAt + length;
  *at++ = static_cast<uint8_t>(crc >> 8);
  *at++ = static_cast<uint8_t>(crc & 0xFF);
  *at = 0;
  // From behind, each zero becomes the code of the block that follows it.
  uint8_t code = 1;
  do {
    --at;
    if (*at == 0) {
      *at = code;
      code = 0;
    }
    ++code;
  } while (at != frame);
}

}  // namespace rr
