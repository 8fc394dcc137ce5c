// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <cstddef>
#include <cstdint>
#include <deque>
#include <memory>

#include "runtime/cpp/src/channel/wire_slots.hpp"

namespace rr::channel {

/// Memories of wires that the other side has passed, until the answers come that they belong to.
/// Not synchronized.
class PassedSlots {
 public:
  /// When there are more, the oldest goes: the other side does not answer.
  static constexpr std::size_t most = 64;

  /// What is no such memory is dropped.
  void add(const platform::Descriptor& handle);
  /// Takes out the one of this number; null when it has not come.
  std::unique_ptr<SlotReader> take(std::uint64_t id);
  [[nodiscard]] std::size_t size() const { return readers_.size(); }

 private:
  std::deque<std::unique_ptr<SlotReader>> readers_;
};

}  // namespace rr::channel
