// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <cstddef>
#include <cstdint>
#include <span>

#include "rr/realtime/layout.hpp"
#include "rr/visibility.hpp"

/// The packet in which real-time nodes exchange state: each is complete, and older ones mean
/// nothing. All numbers have their least significant byte first:
///
///   0   4  `RRSF`
///   4   2  version of this format: 1
///   6   2  bytes of the payload
///   8   8  hash of the layout
///   16  8  epoch: when the sender began, larger for a later begin
///   24  8  sequence number, from 0 in each epoch
///   32  8  time stamp in nanoseconds, by the sender's clock
///   40     payload: the signals as Layout packs them
///   .   4  CRC-32 (that of Ethernet) of all before it
namespace RR_VISIBLE rr {
namespace realtime {

/// What stands before the payload of a frame.
struct FrameHeader {
  std::uint64_t schema = 0;    ///< Layout::hash()
  std::uint64_t epoch = 0;     ///< when the sender began; larger for a later begin
  std::uint64_t sequence = 0;  ///< from 0 in each epoch
  std::int64_t stamp = 0;      ///< nanoseconds

  /// Whether all fields are equal.
  bool operator==(const FrameHeader&) const = default;
};

/// Bytes before the payload.
inline constexpr std::size_t frame_header_size = 40;
/// Bytes of a frame besides its payload: header and checksum.
inline constexpr std::size_t frame_overhead = frame_header_size + 4;
/// Bytes of the largest frame. It fits an Ethernet packet.
inline constexpr std::size_t largest_frame = largest_payload + frame_overhead;

/// Writes header and checksum around the payload, which stands at frame_header_size already.
/// `frame` is as large as payload and frame_overhead. Allocates nothing.
void seal_frame(const FrameHeader& header, std::span<std::byte> frame);

/// What is wrong with a frame.
enum class FrameFault : std::uint8_t {
  none,     ///< nothing
  foreign,  ///< no frame, or one of another version
  damaged,  ///< the length does not fit, or the checksum
};

/// Reads a frame; the payload lies in it. Allocates nothing.
FrameFault open_frame(std::span<const std::byte> frame, FrameHeader& header,
                      std::span<const std::byte>& payload);

}  // namespace realtime
}  // namespace rr
