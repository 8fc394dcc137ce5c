// SPDX-License-Identifier: Apache-2.0
#include "rr/realtime/state_frame.hpp"

#include <array>
#include <concepts>

#include "rr/crc32.hpp"

namespace rr::realtime {
namespace {

constexpr std::array magic{std::byte{'R'}, std::byte{'R'}, std::byte{'S'}, std::byte{'F'}};
constexpr std::uint16_t version = 1;

template <std::unsigned_integral Number>
void put(std::span<std::byte> bytes, std::size_t place, Number number) {
  for (std::size_t i = 0; i < sizeof(Number); ++i) {
    bytes[place + i] = static_cast<std::byte>(number >> (8 * i));
  }
}

template <std::unsigned_integral Number>
Number get(std::span<const std::byte> bytes, std::size_t place) {
  Number number = 0;
  for (std::size_t i = sizeof(Number); i-- > 0;) {
    number = static_cast<Number>((std::uint64_t{number} << 8U) |
                                 std::to_integer<std::uint64_t>(bytes[place + i]));
  }
  return number;
}

}  // namespace

void seal_frame(const FrameHeader& header, std::span<std::byte> frame) {
  const std::size_t end = frame.size() - 4;
  for (std::size_t i = 0; i < magic.size(); ++i) frame[i] = magic[i];
  put(frame, 4, version);
  put(frame, 6, static_cast<std::uint16_t>(end - frame_header_size));
  put(frame, 8, header.schema);
  put(frame, 16, header.epoch);
  put(frame, 24, header.sequence);
  put(frame, 32, static_cast<std::uint64_t>(header.stamp));
  put(frame, end, crc32(frame.first(end)));
}

FrameFault open_frame(std::span<const std::byte> frame, FrameHeader& header,
                      std::span<const std::byte>& payload) {
  if (frame.size() < frame_overhead) return FrameFault::foreign;
  for (std::size_t i = 0; i < magic.size(); ++i) {
    if (frame[i] != magic[i]) return FrameFault::foreign;
  }
  if (get<std::uint16_t>(frame, 4) != version) return FrameFault::foreign;
  const std::size_t end = frame.size() - 4;
  if (get<std::uint16_t>(frame, 6) != end - frame_header_size) return FrameFault::damaged;
  if (get<std::uint32_t>(frame, end) != crc32(frame.first(end))) return FrameFault::damaged;
  header = {.schema = get<std::uint64_t>(frame, 8),
            .epoch = get<std::uint64_t>(frame, 16),
            .sequence = get<std::uint64_t>(frame, 24),
            .stamp = static_cast<std::int64_t>(get<std::uint64_t>(frame, 32))};
  payload = frame.subspan(frame_header_size, end - frame_header_size);
  return FrameFault::none;
}

}  // namespace rr::realtime
