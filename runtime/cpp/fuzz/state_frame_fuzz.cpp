// SPDX-License-Identifier: Apache-2.0
// Datagrams of state, sealed so that they are looked into: what opens is as long as its frame says.
#include <algorithm>
#include <vector>

#include "rr/realtime/state_frame.hpp"
#include "runtime/cpp/fuzz/promise.hpp"

using rr::fuzz::promise;
namespace realtime = rr::realtime;

extern "C" int LLVMFuzzerTestOneInput(const std::uint8_t* data, std::size_t size) {
  const std::span<const std::byte> input = rr::fuzz::input_of(data, size);
  realtime::FrameHeader header;
  std::span<const std::byte> payload;
  if (realtime::open_frame(input, header, payload) == realtime::FrameFault::none) {
    promise(payload.size() + realtime::frame_overhead == input.size(), "a payload fills its frame");
  }
  if (input.size() < realtime::frame_overhead || input.size() > 60'000) return 0;
  std::vector<std::byte> frame(input.begin(), input.end());
  const realtime::FrameHeader sent{.schema = size, .epoch = 1, .sequence = 2, .stamp = -3};
  realtime::seal_frame(sent, frame);
  promise(realtime::open_frame(frame, header, payload) == realtime::FrameFault::none &&
              header.schema == sent.schema && header.stamp == sent.stamp,
          "what is sealed opens");
  frame[data[0] % frame.size()] ^= std::byte{1};
  promise(realtime::open_frame(frame, header, payload) != realtime::FrameFault::none,
          "a changed bit is seen");
  return 0;
}
