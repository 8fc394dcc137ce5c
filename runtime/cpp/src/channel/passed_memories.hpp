// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <cstddef>
#include <cstdint>
#include <deque>
#include <memory>
#include <variant>

#include "runtime/cpp/src/channel/pipe_ring.hpp"
#include "runtime/cpp/src/channel/wire_slots.hpp"

namespace rr::channel {

/// Memories of wires and pipes that the other side has passed, until the answers come that they
/// belong to. Not synchronized.
class PassedMemories {
 public:
  /// When there are more, the oldest goes: the other side does not answer.
  static constexpr std::size_t most = 64;

  /// What is no such memory is dropped.
  void add(const platform::Descriptor& handle);
  /// Takes out the one of this number; null when it has not come, or is of the other kind.
  std::unique_ptr<SlotReader> take_slots(std::uint64_t id);
  std::unique_ptr<PipeRingReader> take_ring(std::uint64_t id);
  [[nodiscard]] std::size_t size() const { return readers_.size(); }

 private:
  using Reader = std::variant<std::unique_ptr<SlotReader>, std::unique_ptr<PipeRingReader>>;

  template <class Kind>
  std::unique_ptr<Kind> take(std::uint64_t id);

  std::deque<Reader> readers_;
};

}  // namespace rr::channel
