// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <cstddef>
#include <cstdint>
#include <functional>
#include <span>
#include <vector>

#include "runtime/arduino/src/rr/protocol.h"

/// The frames of the serial protocol, docs/reference/serial-protocol.md. Bytes in, bytes out; no
/// port.
namespace rr::serial {

struct Frame {
  Kind kind{};
  std::uint8_t sequence = 0;
  std::vector<std::uint8_t> body{};

  bool operator==(const Frame&) const = default;
};

/// The frame as it goes over the line, with both its zeros. The body has 248 bytes at most.
std::vector<std::uint8_t> stuff(const Frame& frame);

/// Finds good frames in what comes over the line; all else is dropped.
class FrameFinder {
 public:
  /// Calls `use` for each frame that the bytes complete.
  void take(std::span<const std::uint8_t> bytes, const std::function<void(const Frame&)>& use);
  /// Forgets what has been begun.
  void reset() { piece_.clear(); }
  /// Pieces between zeros that were no frame.
  [[nodiscard]] std::uint64_t dropped() const { return dropped_; }

 private:
  std::vector<std::uint8_t> piece_;
  std::uint64_t dropped_ = 0;
};

}  // namespace rr::serial
