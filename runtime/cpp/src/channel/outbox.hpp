// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <cstddef>
#include <cstdint>
#include <memory>
#include <span>
#include <vector>

#include "rr/buffer.hpp"
#include "rr/writer.hpp"

namespace rr::channel {

class Carrier;

/// Bytes that wait to be sent on one connection: what the socket did not take, and answers that
/// leave together. Owns memory only while there are some.
class Outbox {
 public:
  [[nodiscard]] bool empty() const { return first_ == segments_.size(); }
  [[nodiscard]] std::size_t size() const { return size_; }

  /// Takes what is left of a message behind its first `sent` bytes: copies what the writer holds or
  /// borrows, and keeps what has an owner.
  void add(Writer& message, std::size_t sent);
  struct Queued {
    std::uint64_t* mark = nullptr;  ///< the caller's, for this stream while it waits; null: dropped
    bool is_replacement = false;
  };
  /// Takes a whole message in place of one of the same stream that waits, unless it is the older of
  /// the two: then it is dropped.
  Queued add_newest(Writer& message, std::uint64_t stream, std::int64_t time);
  /// Takes over the first `size` bytes of a piece of memory: whole messages.
  void add(Allocation memory, std::size_t size);
  /// Takes a whole message, and puts it before what waits. It stays behind a message of which a
  /// part has been sent, behind other urgent ones, and behind what fix_order() was said of.
  void add_urgent(Writer& message);
  /// No urgent message that comes later overtakes what waits now.
  void fix_order() { fixed_ = size_; }

  /// Sends on a socket: what waits, then `more`, without blocking, in as few calls as possible.
  /// What is sent of the outbox is dropped from it. Returns the bytes of `more` that were sent, or
  /// platform::broken. With a carrier it is that which takes them.
  std::ptrdiff_t send(int socket, std::span<const Piece> more, Carrier* carrier = nullptr);

  void clear();

 private:
  struct Segment {
    MemoryRef owner;
    const std::byte* data = nullptr;
    std::size_t size = 0;
    std::size_t room = 0;   ///< bytes behind the data that may be appended to
    bool is_alone = false;  ///< a message that may be replaced: nothing is appended
    bool is_begun = false;  ///< a part of it has been sent
    /// Bytes from its begin on that belong to a message which has begun before it; may be more than
    /// it has. Behind them messages begin, one after the other.
    std::size_t lead = 0;
    std::size_t sent = 0;  ///< bytes before the data that were sent; they can still be read
  };

  // A message that may be replaced, alone in its segment.
  struct Replaceable {
    std::uint64_t stream = 0;
    std::int64_t time = 0;
    std::size_t segment = 0;
    std::uint64_t mark = 0;
  };

  void append(std::span<const std::byte> bytes, std::size_t lead);
  static Segment copied(std::span<const std::byte> bytes, std::size_t capacity, std::size_t lead);
  static Segment kept(MemoryRef owner, std::span<const std::byte> bytes, std::size_t lead);
  [[nodiscard]] std::size_t rest_of_begun() const;
  std::size_t split(std::size_t offset);
  [[nodiscard]] std::size_t offset_of(std::size_t segment) const;
  void drop(std::size_t bytes);
  void compact();
  Replaceable* find(std::uint64_t stream);
  void fill(Segment& segment, Writer& message);

  std::vector<Segment> segments_;
  std::vector<Replaceable> replaceable_;
  std::size_t first_ = 0;
  std::size_t size_ = 0;
  std::size_t fixed_ = 0;  // of the bytes that wait: so many are not overtaken
};

}  // namespace rr::channel
