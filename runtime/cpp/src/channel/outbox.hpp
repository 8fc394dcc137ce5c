// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <cstddef>
#include <memory>
#include <span>
#include <vector>

#include "rr/buffer.hpp"
#include "rr/writer.hpp"

namespace rr::channel {

/// Bytes that wait to be sent on one connection: what the socket did not take, and answers that
/// leave together. Owns memory only while there are some.
class Outbox {
 public:
  [[nodiscard]] bool empty() const { return first_ == segments_.size(); }
  [[nodiscard]] std::size_t size() const { return size_; }

  /// Takes what is left of a message behind its first `sent` bytes: copies what the writer holds or
  /// borrows, and keeps what has an owner.
  void add(Writer& message, std::size_t sent);
  void add(std::span<const std::byte> bytes);
  /// Takes over the first `size` bytes of a piece of memory.
  void add(Allocation memory, std::size_t size);

  /// Sends on a socket: what waits, then `more`, without blocking, in as few calls as possible.
  /// What is sent of the outbox is dropped from it. Returns the bytes of `more` that were sent, or
  /// -1, with errno, when the connection is broken.
  std::ptrdiff_t send(int socket, std::span<const Piece> more);

  void clear();

 private:
  struct Segment {
    MemoryRef owner;
    const std::byte* data = nullptr;
    std::size_t size = 0;
    std::size_t room = 0;  ///< bytes behind the data that may be appended to
  };

  void drop(std::size_t bytes);

  std::vector<Segment> segments_;
  std::size_t first_ = 0;
  std::size_t size_ = 0;
};

}  // namespace rr::channel
