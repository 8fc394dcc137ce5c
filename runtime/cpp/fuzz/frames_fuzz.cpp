// SPDX-License-Identifier: Apache-2.0
// What comes over a serial line: the same frames are found however it is cut, and each comes back
// when it is sent again.
#include <vector>

#include "runtime/cpp/fuzz/promise.hpp"
#include "runtime/cpp/src/serial/frames.hpp"

using rr::fuzz::promise;
using rr::serial::Frame;
using rr::serial::FrameFinder;

namespace {

std::vector<Frame> found(std::span<const std::uint8_t> line, std::size_t piece) {
  std::vector<Frame> frames;
  FrameFinder finder;
  while (!line.empty()) {
    const std::size_t count = std::min(piece, line.size());
    finder.take(line.first(count), [&](const Frame& frame) { frames.push_back(frame); });
    line = line.subspan(count);
  }
  return frames;
}

}  // namespace

extern "C" int LLVMFuzzerTestOneInput(const std::uint8_t* data, std::size_t size) {
  if (size == 0) return 0;
  const std::span line(data + 1, size - 1);
  const std::vector<Frame> frames = found(line, std::max<std::size_t>(line.size(), 1));
  promise(frames == found(line, std::size_t{1} + data[0]), "pieces make no difference");
  for (const Frame& frame : frames) {
    const std::vector<Frame> again = found(rr::serial::stuff(frame), 1000);
    promise(again.size() == 1 && again.front() == frame, "a frame comes back as it was");
  }
  // Anything can be the body of a known kind.
  Frame own{.kind = rr::serial::Kind::Packet, .sequence = data[0]};
  const std::size_t longest = std::min<std::size_t>(line.size(), 248);
  own.body.assign(line.begin(), line.begin() + static_cast<std::ptrdiff_t>(longest));
  const std::vector<Frame> sent = found(rr::serial::stuff(own), 7);
  promise(sent.size() == 1 && sent.front() == own, "what is sent is found");
  return 0;
}
