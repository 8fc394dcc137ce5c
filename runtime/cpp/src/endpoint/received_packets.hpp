// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <cstddef>
#include <cstdint>
#include <deque>
#include <map>
#include <memory>

#include "rr/pipes.hpp"
#include "runtime/cpp/src/channel/account.hpp"

namespace rr::endpoint {

/// The packets that have come to one end of a pipe and were not taken yet: a queue in the order of
/// their numbers, and those that have come before earlier ones.
///
/// Both have limits, in packets and bytes, and each packet is drawn from the account of the other
/// side for as long as it is here. No lock of itself: that of the end guards it.
class ReceivedPackets {
 public:
  struct Packet {
    std::shared_ptr<void> value;
    std::size_t size = 0;  ///< bytes of its message
    std::size_t cost = 0;  ///< bytes that are drawn for it
  };
  using Held = std::map<std::uint32_t, Packet>;

  /// `account`: of the other side; null where nobody counts.
  explicit ReceivedPackets(std::shared_ptr<channel::Account> account);

  /// Limits of the queue from now on, which do not concern what is in it.
  void set_limit(std::size_t packets, WhenFull when_full, std::size_t bytes);
  /// Takes a packet of `size` bytes of a message and `memory` bytes of containers, whose number
  /// counts for nothing. False when the end is to be closed: the queue is full, or the other side
  /// makes this one hold too much.
  [[nodiscard]] bool add(std::shared_ptr<void> value, std::size_t size, std::size_t memory);
  /// The same for one with a number. The first is 1. One that has come before earlier ones waits
  /// for these; one whose number has passed, or is here, is dropped.
  [[nodiscard]] bool add_numbered(std::uint32_t number, std::shared_ptr<void> value,
                                  std::size_t size, std::size_t memory);

  /// The number of the packet that is to come next.
  [[nodiscard]] std::uint32_t expected() const { return expected_; }
  [[nodiscard]] bool empty() const { return queue_.empty(); }
  /// Packets of the queue.
  [[nodiscard]] std::size_t size() const { return queue_.size(); }
  /// The next one's value, which stays. Only when there is one.
  [[nodiscard]] const std::shared_ptr<void>& front() const { return queue_.front().value; }
  /// Takes the next one. Only when there is one.
  std::shared_ptr<void> pop();
  /// Packets that were dropped, because the queue was full.
  [[nodiscard]] std::size_t lost_count() const { return lost_; }
  /// Those that wait for earlier ones will not get into the queue any more. They are the caller's,
  /// who destroys them without a lock.
  [[nodiscard]] Held drop_held();

 private:
  [[nodiscard]] bool hold_back(std::uint32_t number, Packet packet);
  [[nodiscard]] bool push(Packet packet);
  [[nodiscard]] bool draw(std::size_t cost);
  void give_back(std::size_t cost);

  std::uint32_t expected_ = 1;
  Held held_;
  std::size_t held_bytes_ = 0;
  std::deque<Packet> queue_;
  std::size_t queue_bytes_ = 0;
  channel::Charge charge_;  // for packets that are held back or in the queue, and a little more
  std::size_t cost_ = 0;    // of those packets
  std::size_t limit_;
  std::size_t byte_limit_;
  WhenFull when_full_ = WhenFull::close;
  std::size_t lost_ = 0;
};

}  // namespace rr::endpoint
