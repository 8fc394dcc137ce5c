// SPDX-License-Identifier: Apache-2.0
// Frames that the board makes, beside those of a second encoder.
#include "rr/frame.h"

#include <gtest/gtest.h>

#include <algorithm>
#include <random>
#include <vector>

#include "runtime/arduino/test/wired_board.hpp"

namespace rr {
namespace {

/// What is sent for a body; nothing where a byte behind the frame was written.
std::vector<uint8_t> made(serial::Kind kind, uint8_t sequence, const std::vector<uint8_t>& body) {
  const std::size_t size = body.size() + serial::frameOverhead + stuffing;
  std::vector<uint8_t> memory(size + 1, 0xA5);
  std::copy(body.begin(), body.end(), memory.begin() + sentBodyAt);
  finishFrame(memory.data(), kind, sequence, static_cast<uint8_t>(body.size()));
  if (memory.back() != 0xA5) return {};
  memory.pop_back();
  memory.insert(memory.begin(), 0);  // the zero in front is sent, not kept
  return memory;
}

TEST(Frames, OfEachLengthAreStuffedInPlace) {
  std::mt19937 random(1);
  for (std::size_t length = 0; length <= serial::bodyLimit; ++length) {
    // From all zeros to none.
    for (unsigned zeros = 0; zeros <= 8; ++zeros) {
      std::vector<uint8_t> body(length);
      for (uint8_t& byte : body) {
        byte = random() % 8 < zeros ? uint8_t{0} : static_cast<uint8_t>(1 + random() % 255);
      }
      const auto sequence = static_cast<uint8_t>(random());
      const auto kind = serial::Kind::Reply;
      ASSERT_EQ(made(kind, sequence, body), testing::stuffed({kind, sequence, body})) << length;
    }
  }
}

}  // namespace
}  // namespace rr
