// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <chrono>
#include <cstddef>
#include <cstdint>
#include <string>
#include <vector>

/// What robots of the fleet matrix send, and readers compare with what they get.
namespace rr::gateway::matrix {

/// Of each robot.
inline const std::string definition = R"(service test.load
stdver 0.10

object Load
  pipe uint64[] packets [readonly]
  wire double[] level [readonly]
  function uint64 run(uint64 id)
end
)";

/// Numbers in a packet: 128 bytes.
inline constexpr std::size_t packet_size = 16;

/// Spreads the bits of a number (splitmix64), so that no two items of packets look alike.
inline std::uint64_t spread(std::uint64_t number) {
  number += 0x9E3779B97F4A7C15U;
  number = (number ^ (number >> 30U)) * 0xBF58476D1CE4E5B9U;
  number = (number ^ (number >> 27U)) * 0x94D049BB133111EBU;
  return number ^ (number >> 31U);
}

/// The packet of a robot with this number, from 1: robot, number, and items that follow from both.
inline std::vector<std::uint64_t> packet_of(std::uint64_t robot, std::uint64_t number) {
  std::vector<std::uint64_t> items{robot, number};
  while (items.size() < packet_size) {
    items.push_back(spread((robot << 40U) ^ (number << 4U) ^ items.size()));
  }
  return items;
}

/// What `run` gives back for a call.
inline std::uint64_t answer_of(std::uint64_t robot, std::uint64_t id) {
  return spread(id ^ (robot << 48U));
}

/// Seconds of the clock that all processes of this machine share.
inline double seconds_now() {
  return std::chrono::duration<double>(std::chrono::steady_clock::now().time_since_epoch()).count();
}

}  // namespace rr::gateway::matrix
