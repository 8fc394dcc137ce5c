// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <stdint.h>

/// Numbers of the serial protocol, docs/reference/serial-protocol.md. Read by the board and by the host.
namespace rr {
namespace serial {

/// The first byte of a frame.
enum class Kind : uint8_t {
  // From the host. All but Ack are answered.
  Hello = 0x01,   ///< begins a session
  Text = 0x02,    ///< asks for a piece of a text
  Get = 0x03,     ///< of a property, or a peek at a wire
  Set = 0x04,     ///< of a property
  Call = 0x05,    ///< of a function
  Child = 0x06,   ///< follows an objref
  Open = 0x07,    ///< of a wire or pipe
  Close = 0x08,   ///< of a wire or pipe
  Packet = 0x09,  ///< a value for a wire or pipe
  Answer = 0x0A,  ///< to a callback
  Ping = 0x0B,    ///< whether anybody is there
  Ack = 0x0C,     ///< of a frame with an event, a packet or a callback
  // From the board.
  Reply = 0x81,
  Error = 0x82,
  NoSession = 0x83,  ///< instead of a reply: the board has been reset, say Hello first
  Event = 0x84,
  OutPacket = 0x85,  ///< of a pipe
  Ask = 0x86,        ///< a callback
  WireValue = 0x87,  ///< not acknowledged: the next one is newer
  Started = 0x88,    ///< sent once after a reset
};

constexpr uint8_t protocolVersion = 1;
/// Bytes of a frame that are there whatever is in it: kind, sequence number, length, CRC.
constexpr uint8_t frameOverhead = 5;
/// The longest body. With it a frame has 253 bytes, so that one stuffing byte is always enough.
constexpr uint8_t bodyLimit = 248;
/// Each board takes and gives bodies of this length at least.
constexpr uint8_t bodyMinimum = 32;
/// The text that says why the last request was refused.
constexpr uint8_t reasonText = 255;
/// Codes from here on are the exceptions of the definition, in its order.
constexpr uint8_t firstException = 192;

/// CRC-16 with the polynomial 0x1021, highest bit first.
constexpr uint16_t crcStart = 0xFFFF;
inline uint16_t crcOf(uint16_t crc, uint8_t byte) {
  uint8_t x = static_cast<uint8_t>((crc >> 8) ^ byte);
  x = static_cast<uint8_t>(x ^ (x >> 4));
  // By bytes: a small processor shifts words bit by bit.
  const uint8_t high =
      static_cast<uint8_t>(static_cast<uint8_t>(crc) ^ static_cast<uint8_t>(x << 4) ^ (x >> 3));
  const uint8_t low = static_cast<uint8_t>(x ^ static_cast<uint8_t>(x << 5));
  return static_cast<uint16_t>(static_cast<uint16_t>(high) << 8 | low);
}

}  // namespace serial
}  // namespace rr
