// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <atomic>
#include <cstddef>
#include <cstdint>

#include "rr/buffer.hpp"
#include "rr/writer.hpp"
#include "runtime/cpp/src/channel/metrics.hpp"
#include "runtime/cpp/src/channel/stream_sizes.hpp"

namespace rr::channel {

/// Whole messages in one piece of memory, which are to leave in one system call.
///
/// No lock of itself: that of its owner guards it. bytes() and what it has counted may be asked by
/// any thread without that.
class GatheredMessages {
 public:
  /// Bytes of the piece of memory, which is allocated by the first message.
  static constexpr std::size_t capacity = stream_chunk;

  struct Taken {
    Allocation memory;
    std::size_t size = 0;  ///< bytes of it
  };

  [[nodiscard]] bool empty() const { return size_ == 0; }
  [[nodiscard]] bool has_room_for(std::size_t size) const { return size <= capacity - size_; }
  /// Copies a message, for which there is room. Throws std::bad_alloc.
  void add(Writer& message);
  /// One more of them is a packet.
  void note_packet() { packets_.add(1); }
  /// Gives away all. What was counted stays.
  Taken take();

  /// Of what is gathered.
  [[nodiscard]] std::size_t bytes() const { return bytes_.load(std::memory_order_relaxed); }
  // What was gathered ever.
  [[nodiscard]] std::uint64_t message_count() const { return messages_.get(); }
  [[nodiscard]] std::uint64_t byte_count() const { return all_bytes_.get(); }
  [[nodiscard]] std::uint64_t packet_count() const { return packets_.get(); }

 private:
  Allocation memory_;
  std::size_t size_ = 0;
  std::atomic<std::size_t> bytes_{0};  // the same
  Tally messages_;
  Tally all_bytes_;
  Tally packets_;
};

}  // namespace rr::channel
