// SPDX-License-Identifier: Apache-2.0
// Whatever comes over the line: the first byte says whether the rest is bytes as they are, or
// bodies of requests, which get good frames around them so that they reach the members.
#include <algorithm>
#include <cstddef>
#include <cstdint>
#include <cstdlib>
#include <vector>

#include "runtime/arduino/test/wired_board.hpp"

extern "C" int LLVMFuzzerTestOneInput(const std::uint8_t* data, std::size_t size) {
  if (size == 0) return 0;
  rr::testing::WiredBoard board;
  board.hello();
  const std::vector<std::uint8_t> bytes(data + 1, data + size);
  if (data[0] % 2 == 0) {
    (void)board.say(bytes);
  } else {
    std::uint8_t sequence = 0;
    for (std::size_t at = 0; at + 2 < bytes.size();) {
      const std::size_t length = std::min<std::size_t>(bytes[at + 1] % 64, bytes.size() - at - 2);
      const rr::testing::Frame frame{
          static_cast<rr::serial::Kind>(bytes[at] % 0x10),
          ++sequence,
          {bytes.begin() + static_cast<std::ptrdiff_t>(at + 2),
           bytes.begin() + static_cast<std::ptrdiff_t>(at + 2 + length)}};
      for (const rr::testing::Frame& answer : board.say(frame)) {
        if (answer.body.size() > rr::serial::bodyLimit) std::abort();
      }
      at += 2 + length;
    }
  }
  // Whatever came, the next good frame is understood.
  board.hello(9);
  const auto answers = board.say({rr::serial::Kind::Ping, 1, {}});
  if (!board.link.isConnected() || answers.empty()) std::abort();
  return 0;
}
